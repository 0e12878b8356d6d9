"""The checksum of chunks is that of zlib, with the library isal and without."""

import importlib
import sys
import zlib
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.kits.record.mcap import checksum


@pytest.fixture
def without_isal(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "isal.isal_zlib", None)
        importlib.reload(checksum)
        yield
    importlib.reload(checksum)


@given(st.binary(max_size=600), st.binary(max_size=600))
def test_it_goes_on_from_what_was_before(first: bytes, second: bytes) -> None:
    both = checksum.crc32(second, checksum.crc32(memoryview(first)))
    assert both == zlib.crc32(first + second)


def test_it_is_that_of_isal() -> None:
    isal = pytest.importorskip("isal.isal_zlib")
    assert checksum.crc32 is isal.crc32


def test_without_isal_it_is_that_of_zlib(without_isal: None) -> None:
    assert checksum.crc32 is zlib.crc32
