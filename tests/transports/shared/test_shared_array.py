"""Shared arrays: how the memory that bytes lie in is found again, and when it is not."""

from __future__ import annotations

import mmap
from functools import partial
from typing import Any

import numpy as np
import pytest

import yarpy
from yarpy.data import codec
from yarpy.transports.shared.shared_array import (
    HEADROOM,
    address_of,
    freeze,
    place_of,
    shared_array_type,
)

SIZE = 1 << 17


class Memory:
    """A source."""

    descriptors = ()

    def __init__(self) -> None:
        self.file = mmap.mmap(-1, SIZE)
        self.address = address_of(self.file)

    def shared(self, offset: int = 0, size: int = SIZE) -> Any:
        shared = shared_array_type()(size, "u1", self.file, offset)
        shared.source, shared.offset = self, offset
        return shared


@pytest.fixture
def memory() -> Memory:
    return Memory()


def test_the_bytes_themselves(memory: Memory) -> None:
    shared = memory.shared(4096, 50000)
    assert place_of([memoryview(shared)]) == (memory, 4096, shared)
    assert place_of([memoryview(shared)[10:30000]]) == (memory, 4106, shared)


def test_arrays_of_arrays(memory: Memory) -> None:
    shared = memory.shared(4096, 50000)[1:]
    array = np.frombuffer(memoryview(memory.shared(4096, 100000)), "u2", 40000, 200)
    block = array.reshape(200, 200)[20:120].data.cast("B")
    found = place_of([block])
    assert found is not None
    assert found[:2] == (memory, 4096 + 200 + 20 * 400)
    assert place_of([memoryview(shared)]) is None  # numpy made that, of ours


def test_a_received_picture(memory: Memory) -> None:
    """Its head lies in front of the pixels already."""
    payload = b"".join(yarpy.Image(np.ones((200, 200), "u1")).to_wire())
    memory.file[512 : 512 + len(payload)] = payload
    image = codec.decode(memoryview(memory.shared(512, len(payload))))
    found = place_of(codec.encode(image))
    assert found is not None
    assert found[:2] == (memory, 512)
    found = place_of(codec.encode(image.array))
    assert found is not None
    assert found[:2] == (memory, 512)
    assert place_of(codec.encode(image.array[10:])) is None  # other pixels are in front of these
    assert place_of(codec.encode(yarpy.Image(image.array, quantum=1))) is None
    assert place_of(codec.encode([image.array.tobytes()])) is None


def test_other_bytes(memory: Memory) -> None:
    array = np.zeros(SIZE, "u1")
    shared = shared_array_type()(SIZE, "u1")
    assert place_of([]) is None
    assert place_of([b"x" * SIZE]) is None
    assert place_of([memoryview(bytearray(SIZE))]) is None
    assert place_of([array.data]) is None
    assert place_of([memoryview(shared)]) is None  # in place of shared memory
    assert place_of([memoryview(memory.shared())[:100]]) is None
    assert place_of([memoryview(memory.shared()), b"tail"]) is None
    assert place_of([b"head", memoryview(memory.shared())]) is None  # that would be in front of it
    assert place_of([b"x" * (HEADROOM + 1), memoryview(memory.shared())[1000:]]) is None


def test_what_was_written_cannot_be_changed(memory: Memory) -> None:
    shared = memory.shared()
    array = np.ndarray((200, 200), "u1", shared, HEADROOM)
    rows = array[10:]
    freeze(None, [b"head", rows.data.cast("B")])
    assert not any(one.flags.writeable for one in (array, rows, shared))
    with pytest.raises(ValueError, match="read-only"):
        rows[0, 0] = 1
    freeze(None, [])
    freeze(None, [b"x"])
    freeze(None, [memoryview(bytearray(SIZE))])
    small = np.ndarray((2, 2), "u1", memory.shared(), HEADROOM)
    freeze(small, [small.tobytes()])
    assert not small.flags.writeable
    own = np.zeros(5)
    freeze(own, [own.data.cast("B")])
    assert own.flags.writeable


def test_the_end_is_told(memory: Memory) -> None:
    ends: list[int] = []
    shared = memory.shared()
    shared.ended = partial(ends.append, 5)
    view = np.frombuffer(memoryview(shared), "u1")[5:]
    del shared
    assert ends == []
    del view
    assert ends == [5]
