"""What a recorder takes in, and what it has to leave."""

import threading
import time

import pytest
from support.recordings import payload_of

from yarpy.kits.record.intake import OVERHEAD, Intake, own
from yarpy.wire.message import DATA, Message


def message(value: object = 1, source: str = "/a", envelope: str = "") -> Message:
    found = Message(DATA, payload_of(value), envelope)
    found.source = source
    return found


def test_messages_wait_in_their_order() -> None:
    intake = Intake()
    before = time.time_ns()
    for n in range(5):
        intake.put(message(n, "/ab"[: 1 + n % 2 + 1], f"{n} 1"))
    found = intake.take()
    assert [one.envelope for one in found] == [f"{n} 1" for n in range(5)]
    times = [one.received_ns for one in found]
    assert times == sorted(times) and before <= times[0] <= times[-1] <= time.time_ns()
    assert intake.take() == [] and intake.held == sum(one.size for one in found)
    assert sum(count.messages for count in intake.counts.values()) == 5


def test_full_memory_loses_and_counts() -> None:
    size = len(payload_of("x" * 100)) + OVERHEAD
    intake = Intake(memory=2 * size)
    for _ in range(5):
        intake.put(message("x" * 100))
    count = intake.counts["/a"]
    assert (count.messages, count.lost, intake.held) == (2, 3, 2 * size)
    for taken in intake.take():
        intake.free(taken.size)
    intake.put(message("x" * 100))
    assert (count.messages, count.lost) == (3, 3)


def test_what_could_not_be_written_is_lost() -> None:
    intake = Intake()
    intake.put(message("abc"))
    (taken,) = intake.take()
    intake.lose(taken)
    count = intake.counts["/a"]
    assert (count.messages, count.bytes, count.lost) == (0, 0, 1)


def test_a_paused_recorder_takes_nothing() -> None:
    intake = Intake()
    intake.paused = True
    intake.put(message())
    assert intake.take() == [] and intake.counts == {}


def test_rates(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [10**12]
    monkeypatch.setattr(time, "monotonic_ns", lambda: now[0])
    intake = Intake(rates={"/cam/*": 10.0, "/cam/right": 5.0})
    for _ in range(100):  # a second, 100 messages a second
        for source in ("/cam/left", "/cam/right", "/state"):
            intake.put(message(source=source))
        now[0] += 10_000_000
    found = {name: (count.messages, count.left_out) for name, count in intake.counts.items()}
    assert found == {"/cam/left": (10, 90), "/cam/right": (5, 95), "/state": (100, 0)}


def test_what_follows_what(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that what was not taken is not said to have never arrived."""
    intake = Intake(memory=3 * (len(payload_of(1)) + OVERHEAD))
    for _ in range(2):
        intake.put(message())
    intake.paused = True
    intake.put(message())
    intake.paused = False
    for _ in range(2):
        intake.put(message())  # the second one has no room
    for taken in intake.take():
        intake.free(taken.size)
    intake.put(message())
    intake.put(message())
    taken = intake.take()
    assert [one.follows for one in taken] == [False, True]
    intake.free(sum(one.size for one in taken))
    intake.put(message())
    intake.forget("/a")
    intake.put(message())
    assert [taken.follows for taken in intake.take()] == [True, False]
    assert intake.counts["/a"].lost == 1


def test_waiting_ends_when_much_has_come() -> None:
    intake = Intake(memory=8000)
    thread = threading.Thread(target=intake.wait, args=(30,))
    thread.start()
    intake.put(message("x" * 1000))
    thread.join(20)
    assert not thread.is_alive()


def test_what_does_not_stay_as_it_is_is_copied() -> None:
    data = bytearray(payload_of("hello"))
    whole = Message(DATA, memoryview(data))
    assert own(whole) is whole.payload
    part = Message(DATA, memoryview(bytearray(1 << 20))[:10])
    assert type(own(part)) is bytes
    text = Message(DATA, b"1 2 hello", spelling="text")
    assert own(text) == payload_of([1, 2, "hello"])
    values = [1, 2]
    kept = own(Message(DATA, values, spelling="object"))
    values.append(3)
    assert kept == payload_of([1, 2])


def test_what_cannot_be_kept_is_counted() -> None:
    intake = Intake()
    odd = Message(DATA, object(), spelling="object")
    odd.source = "/odd"
    intake.put(odd)
    assert intake.counts["/odd"].lost == 1


def test_what_comes_after_the_end_is_refused() -> None:
    intake = Intake()
    intake.put(message(1, "/a"))
    assert [taken.port for taken in intake.end()] == ["/a"]
    intake.put(message(2, "/a"))
    assert intake.take() == [] and intake.counts["/a"].lost == 1
