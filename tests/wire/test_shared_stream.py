"""SharedStream: an ordinary stream that knows of memory beside it."""

from __future__ import annotations

from yarpy.testing.drive import SimulatedMemory
from yarpy.wire.shared_stream import SharedStream
from yarpy.wire.stream import run


def test_bytes_come_as_in_any_stream_and_the_memory_is_beside_it() -> None:
    memory = SimulatedMemory([])
    stream = SharedStream(memory, limit=100)
    assert run(stream.read_exact(3), stream, [b"a", b"bc"]) == b"abc"
    payload = stream.memory.place([b"large", b"r"], 6)
    assert payload is not None
    where = stream.memory.lend(payload)
    taken = stream.memory.take(
        where, payload.slot, payload.generation, payload.offset, payload.size
    )
    assert taken == b"larger"
    assert (stream.limit, stream.aside, stream.came_aside) == (100, 0, 0)
