"""The last seconds of what came, in bounded memory, and what lets them be written."""

import pytest
from support.recordings import START, payload_of

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.capture.queue import QueuedMessage
from yarpy.kits.record.capture.ring_buffer import RingBuffer
from yarpy.kits.record.envelope import SECOND


def taken(second: float, value: object = 1, port: str = "/a", size: int = 100) -> QueuedMessage:
    return QueuedMessage(port, START + round(second * SECOND), "", payload_of(value), size)


class Clock:
    """Nanoseconds that a test sets."""

    seconds = 0.0

    def __call__(self) -> int:
        return round(self.seconds * SECOND)


def test_what_is_older_goes() -> None:
    clock = Clock()
    ring = RingBuffer(10, 10_000, {}, clock)
    for second in range(30):
        clock.seconds = second
        assert not ring.add(taken(second))
        ring.note({"n": second}, START + second * SECOND)
    messages, notes = ring.drain()
    assert [one.received_ns for one in messages] == [START + n * SECOND for n in range(19, 30)]
    assert [what["n"] for what, _ in notes] == [*range(19, 30)]
    assert ring.held == 0
    assert ring.drain() == ([], [])


def test_what_has_become_old_since() -> None:
    clock = Clock()
    ring = RingBuffer(10, 10_000, {}, clock)
    ring.add(taken(0))
    clock.seconds = 11
    assert ring.drain() == ([], [])


def test_no_more_than_the_memory() -> None:
    ring = RingBuffer(10, 1000, {})
    for n in range(100):
        ring.add(taken(n / 100))
        assert ring.held <= 1000
    assert len(ring.drain()[0]) == 10


def test_a_clock_that_is_set_back_and_forward() -> None:
    """What came before is as old as it was."""
    clock = Clock()
    ring = RingBuffer(10, 10_000, {}, clock)
    said = (95, 100, 0, 4, 108, 5000)
    for clock.seconds, second in zip((0, 5, 6, 10, 14, 15), said, strict=True):
        ring.add(taken(second))
    ring.note({"n": 8}, START + 8 * SECOND)
    messages, notes = ring.drain()
    seconds = [(one.received_ns - START) // SECOND for one in messages]
    assert (seconds, len(notes)) == ([100, 0, 4, 108, 5000], 1)


def test_a_trigger_fires_once_for_what_lasts() -> None:
    ring = RingBuffer(10, 100_000, {"/imu": "fall|tilt"})
    said = ["stands", "fall", "fall", "stands", "tilt"]
    fired = [ring.add(taken(n, [word], "/imu")) for n, word in enumerate(said)]
    assert fired == [False, True, False, False, True]
    assert not ring.add(taken(9, ["fall"], "/other"))


def test_what_a_trigger_cannot_read() -> None:
    ring = RingBuffer(10, 1 << 20, {"/imu": "fall"})
    assert not ring.add(QueuedMessage("/imu", START, "", b"\xff" * 20, 100))
    assert not ring.add(taken(1, ["fall" + "x" * (1 << 16)], "/imu"))


@pytest.mark.parametrize("pattern", ["", "("])
def test_what_is_no_trigger(pattern: str) -> None:
    with pytest.raises(LocalProtocolError):
        RingBuffer(10, 1000, {"/imu": pattern})
