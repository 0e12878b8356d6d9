"""SharedStream: an ordinary stream that knows of memory beside it."""

from __future__ import annotations

from yarpy.testing.drive import Shelf
from yarpy.wire.shared_stream import SharedStream
from yarpy.wire.stream import run


def test_bytes_come_as_in_any_stream_and_the_memory_is_beside_it() -> None:
    shelf = Shelf([])
    stream = SharedStream(shelf, limit=100)
    assert run(stream.read_exact(3), stream, [b"a", b"bc"]) == b"abc"
    parcel = stream.memory.place([b"large", b"r"], 6)
    assert parcel is not None
    where = stream.memory.lend(parcel)
    taken = stream.memory.take(where, parcel.slot, parcel.generation, parcel.offset, parcel.size)
    assert taken == b"larger"
    assert (stream.limit, stream.aside, stream.came_aside) == (100, 0, 0)
