"""What a recorder takes in, and what it has to leave."""

import threading
import time

import pytest
from support.recordings import payload_of
from support.wait import HANG

from yarpy.kits.record.capture.queue import OVERHEAD, MessageQueue, own
from yarpy.wire.message import DATA, Message


def message(value: object = 1, source: str = "/a", envelope: str = "") -> Message:
    found = Message(DATA, payload_of(value), envelope)
    found.source = source
    return found


def test_messages_wait_in_their_order() -> None:
    queue = MessageQueue()
    before = time.time_ns()
    for n in range(5):
        queue.put(message(n, "/ab"[: 1 + n % 2 + 1], f"{n} 1"))
    found = queue.take()
    assert [one.envelope for one in found] == [f"{n} 1" for n in range(5)]
    times = [one.received_ns for one in found]
    assert times == sorted(times) and before <= times[0] <= times[-1] <= time.time_ns()
    assert queue.take() == [] and queue.held == sum(one.size for one in found)
    assert sum(count.messages for count in queue.counts.values()) == 5


def test_full_memory_loses_and_counts() -> None:
    size = len(payload_of("x" * 100)) + OVERHEAD
    queue = MessageQueue(memory=2 * size)
    for _ in range(5):
        queue.put(message("x" * 100))
    count = queue.counts["/a"]
    assert (count.messages, count.lost, queue.held) == (2, 3, 2 * size)
    for queued in queue.take():
        queue.free(queued.size)
    queue.put(message("x" * 100))
    assert (count.messages, count.lost) == (3, 3)


def test_newer_messages_replace_older_ones_that_wait() -> None:
    size = len(payload_of("x" * 100)) + OVERHEAD
    queue = MessageQueue(memory=4 * size, newest=["/cam/*"])
    queue.put(message("x" * 100, "/arm", "0 1"))
    for n in range(7):
        queue.put(message("x" * 100, "/cam/left", f"{n} 1"))
    queue.put(message("x" * 100, "/arm", "1 1"))
    cam, arm = queue.counts["/cam/left"], queue.counts["/arm"]
    assert (cam.messages, cam.replaced, cam.lost) == (3, 4, 0)
    assert (arm.messages, arm.replaced, arm.lost) == (1, 0, 1)
    assert cam.bytes == 3 * len(payload_of("x" * 100)) and queue.held == 4 * size
    found = queue.take()
    assert [(one.port, one.envelope[0]) for one in found] == [
        ("/arm", "0"), ("/cam/left", "4"), ("/cam/left", "5"), ("/cam/left", "6"),
    ]  # fmt: skip
    assert [one.follows for one in found[1:]] == [False, True, True]
    queue.put(message("x" * 100, "/cam/left", "7 1"))  # what is being written is not replaced
    assert (cam.replaced, cam.lost) == (4, 1)
    queue.free(queue.held)
    queue.put(message("x" * 500, "/cam/left", "8 1"))
    queue.put(message("x" * 10_000, "/cam/left", "9 1"))  # has no room at all
    assert (cam.replaced, cam.lost, len(queue.take())) == (4, 2, 1)


def test_what_could_not_be_written_is_lost() -> None:
    queue = MessageQueue()
    queue.put(message("abc"))
    (queued,) = queue.take()
    queue.lose(queued)
    count = queue.counts["/a"]
    assert (count.messages, count.bytes, count.lost) == (0, 0, 1)


def test_a_paused_recorder_takes_nothing() -> None:
    queue = MessageQueue()
    queue.paused = True
    queue.put(message())
    assert queue.take() == [] and queue.counts == {}


def test_rates(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [10**12]
    monkeypatch.setattr(time, "monotonic_ns", lambda: now[0])
    queue = MessageQueue(rates={"/cam/*": 10.0, "/cam/right": 5.0})
    for _ in range(100):  # a second, 100 messages a second
        for source in ("/cam/left", "/cam/right", "/state"):
            queue.put(message(source=source))
        now[0] += 10_000_000
    found = {name: (count.messages, count.left_out) for name, count in queue.counts.items()}
    assert found == {"/cam/left": (10, 90), "/cam/right": (5, 95), "/state": (100, 0)}


def test_what_follows_what(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that what was not taken is not said to have never arrived."""
    queue = MessageQueue(memory=3 * (len(payload_of(1)) + OVERHEAD))
    for _ in range(2):
        queue.put(message())
    queue.paused = True
    queue.put(message())
    queue.paused = False
    for _ in range(2):
        queue.put(message())  # the second one has no room
    for queued in queue.take():
        queue.free(queued.size)
    queue.put(message())
    queue.put(message())
    taken = queue.take()
    assert [one.follows for one in taken] == [False, True]
    queue.free(sum(one.size for one in taken))
    queue.put(message())
    queue.forget("/a")
    queue.put(message())
    assert [queued.follows for queued in queue.take()] == [True, False]
    assert queue.counts["/a"].lost == 1


def test_waiting_ends_when_much_has_come() -> None:
    queue = MessageQueue(memory=8000)
    thread = threading.Thread(target=queue.wait, args=(30,))
    thread.start()
    queue.put(message("x" * 1000))
    thread.join(HANG)
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
    queue = MessageQueue()
    odd = Message(DATA, object(), spelling="object")
    odd.source = "/odd"
    queue.put(odd)
    assert queue.counts["/odd"].lost == 1


def test_what_comes_after_the_end_is_refused() -> None:
    queue = MessageQueue()
    queue.put(message(1, "/a"))
    assert [queued.port for queued in queue.end()] == ["/a"]
    queue.put(message(2, "/a"))
    assert queue.take() == [] and queue.counts["/a"].lost == 1
