"""Arena: room for payloads, who still looks at them, and what happens when there is none left."""

from __future__ import annotations

import gc
import logging
import mmap
import os
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.transports.descriptor import owned
from yarpy.transports.shared import arena as module
from yarpy.transports.shared.arena import PAGE, Arena, arena_of
from yarpy.transports.shared.loan import LEDGER, Borrower, Placed
from yarpy.transports.shared.sealed import F_ADD_SEALS, available, sealed_memory
from yarpy.transports.shared.shared_array import HEADROOM

fcntl: Any = pytest.importorskip("fcntl", reason="only Unix seals memory")
pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")


def sealed(name: str, size: int) -> int:
    """The descriptor of a file that keeps its size, to be given away."""
    file = sealed_memory(name, size)
    return os.dup(file.fileno())


class Peer:
    """A reader, and its end of the pipe and of the ledger."""

    def __init__(self) -> None:
        ledger = sealed("test", LEDGER)
        self.memory = mmap.mmap(ledger, LEDGER)
        self.ledger = memoryview(self.memory).cast("I")
        ours, self.pipe = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        self.reader = Borrower(ledger, *owned([ours]))
        os.close(ledger)

    def give_back(self, placed: Placed | tuple[int, int]) -> None:
        slot, generation = (
            (placed.slot, placed.generation) if isinstance(placed, Placed) else placed
        )
        self.ledger[slot] = generation

    def die(self) -> None:
        if self.pipe >= 0:
            os.close(self.pipe)
            self.pipe = -1


@pytest.fixture
def peer() -> Iterator[Peer]:
    peer = Peer()
    yield peer
    peer.die()


def lent(arena: Arena, peer: Peer, size: int = PAGE) -> tuple[int, int]:
    """A payload that its writer has done with, and the peer has."""
    placed = arena.place([bytes(size)], size)
    assert placed is not None
    assert arena.lend(placed, peer.reader)
    return placed.slot, placed.generation


def test_a_payload_lies_there_in_one_piece() -> None:
    arena = Arena("/out", 4 * PAGE)
    placed = arena.place([b"head", bytes(range(256)) * 8], 4 + 2048)
    assert placed is not None
    data = os.pread(arena.number, placed.size, placed.offset)
    assert data == b"head" + bytes(range(256)) * 8


def test_large_blocks_too() -> None:
    arena = Arena("/out", 1 << 20)
    data = os.urandom(500_000)
    placed = arena.place([b"head", data], 4 + len(data))
    assert placed is not None
    assert os.pread(arena.number, placed.size, placed.offset) == b"head" + data


def test_a_writer_does_not_wait_for_the_import_of_numpy() -> None:
    """Which takes seconds in a program whose threads are busy."""
    program = (
        "import sys\n"
        "from yarpy.transports.shared.arena import Arena\n"
        "arena = Arena('/out', 1 << 20)\n"
        "placed = arena.place([memoryview(bytes(500_000) + b'end')], 500_003)\n"
        "assert placed is not None\n"
        "assert arena.view[placed.offset + 500_000 : placed.offset + 500_003] == b'end'\n"
        "assert 'numpy' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=30)


def test_nobody_can_shorten_or_write_it() -> None:
    arena = Arena("/out", 4 * PAGE)
    with pytest.raises(OSError):
        os.ftruncate(arena.number, PAGE)
    with pytest.raises(OSError):
        os.ftruncate(arena.number, 8 * PAGE)
    with pytest.raises(OSError):
        os.write(arena.number, b"x")
    with pytest.raises(OSError):
        fcntl.fcntl(arena.number, F_ADD_SEALS, 0x8000)
    with pytest.raises(OSError):
        mmap.mmap(arena.number, PAGE)  # for writing


def test_room_comes_back_once_the_writer_is_done() -> None:
    arena = Arena("/out", 2 * PAGE)
    first = arena.place([bytes(PAGE)], PAGE)
    second = arena.place([bytes(PAGE)], PAGE)
    assert first is not None
    assert second is not None
    assert (first.offset, second.offset) == (0, PAGE)
    assert arena.place([b"x"], 1) is None
    del first
    gc.collect()
    third = arena.place([b"x"], 1)
    assert third is not None
    assert (third.offset, arena.used) == (0, 2)


def test_a_reader_keeps_it_until_it_gives_it_back(peer: Peer) -> None:
    arena = Arena("/out", 2 * PAGE)
    held = lent(arena, peer, 2 * PAGE)
    assert arena.place([b"x"], 1) is None
    peer.give_back(held)
    assert arena.place([b"x"], 1) is not None


def test_of_several_readers_the_last_counts(peer: Peer) -> None:
    arena, other = Arena("/out", 2 * PAGE), Peer()
    placed = arena.place([bytes(2 * PAGE)], 2 * PAGE)
    assert placed is not None
    for one in (peer, other):
        assert arena.lend(placed, one.reader)
        assert not arena.lend(placed, one.reader)  # it would not know for which of the two
    peer.give_back(placed)
    held = placed.slot, placed.generation
    del placed
    assert arena.place([b"x"], 1) is None
    other.give_back(held)
    assert arena.place([b"x"], 1) is not None
    other.die()


def test_after_the_end_of_a_connection_views_still_count(peer: Peer) -> None:
    arena = Arena("/out", PAGE)
    held = lent(arena, peer)
    peer.reader.ended = True
    assert arena.used == 1
    peer.give_back(held)
    assert arena.used == 0


def test_a_reader_that_was_killed_keeps_nothing(peer: Peer) -> None:
    arena = Arena("/out", PAGE)
    lent(arena, peer)
    peer.reader.ended = True
    assert arena.used == 1
    peer.die()
    assert arena.used == 0


def test_a_reader_cannot_deceive_us_into_an_error(peer: Peer) -> None:
    """It harms itself alone: what it looks at changes."""
    arena = Arena("/out", PAGE)
    lent(arena, peer)
    for slot in range(len(peer.ledger)):
        peer.ledger[slot] = 0xFFFFFFFF
    assert arena.used == 1
    os.write(peer.pipe, b"noise")
    peer.reader.ended = True
    assert arena.used == 1


def test_without_room_it_says_so_once(
    caplog: pytest.LogCaptureFixture, peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    arena = Arena("/out", PAGE)
    held = lent(arena, peer)
    with caplog.at_level(logging.WARNING, "yarpy"):
        for _ in range(3):
            assert arena.place([b"x"], 1) is None
        assert arena.place([bytes(2 * PAGE)], 2 * PAGE) is None  # never fits: nobody's fault
        for _ in range(5):  # a reader that stays behind gives back one after the other
            peer.give_back(held)
            held = lent(arena, peer)
            assert arena.place([b"x"], 1) is None
        assert len(caplog.records) == 1
        monkeypatch.setattr(module, "CALM", 0.0)
        peer.give_back(held)
        assert arena.place([b"x"], 1) is not None
    texts = [record.getMessage() for record in caplog.records]
    assert len(texts) == 2
    assert "sent as a copy" in texts[0]
    assert "fit again" in texts[1]


def test_slots_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "SLOTS", 3)
    arena = Arena("/out", 100 * PAGE)
    kept = [arena.place([b"x"], 1) for _ in range(4)]
    assert [placed is not None for placed in kept] == [True, True, True, False]


def test_a_system_with_little_memory_is_left_some(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It would kill a program."""
    free = 11 * PAGE
    monkeypatch.setattr(module, "free_memory", lambda: free)
    arena = Arena("/out", 100 * PAGE)
    kept = [arena.place([bytes(PAGE)], PAGE)]
    free = 4 * PAGE
    kept.append(arena.place([bytes(PAGE)], PAGE))
    free = 3 * PAGE
    assert arena.place([bytes(PAGE)], PAGE) is None
    assert arena.prepare(PAGE) is None
    assert all(kept)
    kept.pop()
    assert arena.place([bytes(PAGE)], PAGE) is not None  # it has that already
    said = [one.getMessage() for one in caplog.records if one.levelname == "WARNING"]
    assert "hardly any memory left" in said[0]


def test_a_system_without_memory_to_give(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*arguments: object) -> int:
        raise OSError(28, "No space left on device")

    arena = Arena("/out", 4 * PAGE)
    assert arena.place([b"x"], 1) is not None
    monkeypatch.setattr(os, "posix_fallocate", fails)
    assert arena.place([bytes(PAGE)], PAGE) is not None  # where it has given some before
    assert arena.place([bytes(PAGE), bytes(PAGE)], 2 * PAGE) is None
    monkeypatch.setattr(os, "memfd_create", fails)
    with pytest.raises(LocalProtocolError, match="use the carrier tcp"):
        Arena("/out", 4 * PAGE)


def test_what_cannot_be_mapped_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(12, "Cannot allocate memory")

    held = [sealed_memory("test", PAGE)]
    number = held[0].fileno()
    with monkeypatch.context() as patch:
        patch.setattr(module.mmap, "mmap", refuse)
        patch.setattr(module, "sealed_memory", lambda *_: held.pop())
        with pytest.raises(LocalProtocolError, match="no memory to share"):
            Arena("/out")
    gc.collect()
    with pytest.raises(OSError):
        os.fstat(number)


def test_room_that_a_program_fills_itself(peer: Peer) -> None:
    arena = Arena("/out", 1 << 20)
    shared = arena.prepare(20000)
    shared[HEADROOM:] = 7
    placed = arena.place([b"head", memoryview(shared)[HEADROOM:]], 20004)
    assert placed is not None
    assert os.pread(arena.number, placed.size, placed.offset) == b"head" + bytes([7]) * 20000
    assert placed.offset == HEADROOM - 4  # nothing was copied
    assert not shared.flags.writeable
    arena.lend(placed, peer.reader)
    held = placed.slot, placed.generation
    del placed, shared
    assert arena.used == 1
    second = arena.prepare(20000)
    assert second.offset > 0  # the first is still looked at
    peer.give_back(held)
    assert arena.used == 0
    assert arena.prepare(20000).offset == 0


def test_it_may_be_sent_again_but_not_with_another_head() -> None:
    arena = Arena("/out", 1 << 20)
    pixels = memoryview(arena.prepare(20000))[HEADROOM:]
    offsets = []
    for head in (b"head", b"head", b"HEAD"):
        placed = arena.place([head, pixels], 20004)
        assert placed is not None
        offsets.append(placed.offset)
    assert offsets[:2] == [HEADROOM - 4] * 2
    assert offsets[2] > 20000  # a copy: somebody may look at the first


def test_no_room_to_prepare() -> None:
    arena = Arena("/out", 8 * PAGE)
    assert arena.prepare(8 * PAGE) is None
    kept = arena.prepare(4 * PAGE)
    assert arena.prepare(4 * PAGE) is None
    del kept
    assert arena.prepare(4 * PAGE) is not None


def test_it_ends_while_readers_still_look(peer: Peer) -> None:
    """Not when the garbage is collected."""
    gc.disable()
    try:
        arena = Arena("/out", 1 << 20)
        lent(arena, peer)
        shared = arena.prepare(20000)
        placed = arena.place([memoryview(shared)[HEADROOM:]], 20000)
        assert placed is not None
        arena.lend(placed, peer.reader)
        number = arena.number
        del placed, shared, arena
        with pytest.raises(OSError):
            os.fstat(number)
    finally:
        gc.enable()


def test_a_forked_process_has_arenas_of_its_own() -> None:
    """Two that write into one would not know of each other."""
    arena = arena_of("/one")
    child = os.fork()
    if not child:
        code = 1
        try:
            code = 0 if arena_of("/one") is not arena else 2
        finally:
            os._exit(code)
    assert os.waitpid(child, 0)[1] == 0
    assert arena_of("/one") is arena


def test_a_port_has_one_arena_for_as_long_as_it_is_used() -> None:
    one = arena_of("/one")
    assert arena_of("/one") is one
    assert arena_of("/two") is not one
    number = one.number
    del one
    gc.collect()
    with pytest.raises(OSError):
        os.fstat(number)
