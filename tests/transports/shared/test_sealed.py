"""Files in memory: nobody makes one shorter, and after `forbid_writing` nobody else writes it."""

from __future__ import annotations

import gc
import mmap
import os
from typing import Any

import pytest

from yarpy.transports.shared.sealed import (
    F_GET_SEALS,
    F_SEAL_GROW,
    F_SEAL_SHRINK,
    available,
    forbid_writing,
    sealed_memory,
)

fcntl: Any = pytest.importorskip("fcntl", reason="only Unix seals memory")
pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")

SIZE = 4 * mmap.PAGESIZE


def test_its_size_stays() -> None:
    file = sealed_memory("test", SIZE)
    number = file.fileno()
    assert os.fstat(number).st_size == SIZE
    for size in (SIZE // 2, 2 * SIZE):
        with pytest.raises(PermissionError):
            os.ftruncate(number, size)
    assert fcntl.fcntl(number, F_GET_SEALS) & (F_SEAL_SHRINK | F_SEAL_GROW)


def test_who_has_mapped_it_writes_on_and_nobody_else() -> None:
    file = sealed_memory("test", SIZE)
    ours = mmap.mmap(file.fileno(), SIZE)
    forbid_writing(file.fileno())
    ours[:4] = b"ours"
    with pytest.raises(OSError):
        mmap.mmap(file.fileno(), SIZE)
    theirs = mmap.mmap(file.fileno(), SIZE, access=mmap.ACCESS_READ)
    assert theirs[:4] == b"ours"


def test_an_older_linux_does_without(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> int:
        raise OSError(22, "Invalid argument")

    file = sealed_memory("test", SIZE)
    with monkeypatch.context() as patch:
        patch.setattr(fcntl, "fcntl", refuse)
        forbid_writing(file.fileno())
    mmap.mmap(file.fileno(), SIZE)[:1] = b"x"


def test_it_is_closed_with_the_last_who_has_it() -> None:
    file = sealed_memory("test", SIZE)
    number = file.fileno()
    del file
    gc.collect()
    with pytest.raises(OSError):
        os.fstat(number)
