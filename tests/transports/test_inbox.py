"""The inbox of an endpoint."""

import threading
from typing import Any

import pytest
from support.guest import guest
from support.wait import HANG

from yarpy.errors import LocalProtocolError
from yarpy.transports import inbox
from yarpy.transports.inbox import Inbox

guest("ros2")
from yarpy.peers.ros2.carrier import Incoming, Outgoing  # noqa: E402


class Bare(Inbox):
    def give(self, item: Outgoing) -> None:
        if isinstance(item.kind, Exception):
            raise item.kind


def greeted() -> Inbox:
    found = Bare()
    assert found.receive() == (found,)
    return found


def test_what_comes_is_read_in_order() -> None:
    found = greeted()
    for number in range(3):
        found.put(Incoming(b"x", number), 10)
    assert found.waiting == 3
    assert [found.receive()[0].number for _ in range(3)] == [0, 1, 2]  # type: ignore[index, attr-defined]
    with pytest.raises(BlockingIOError):
        found.receive(wait=False)
    found.limit_waiting(0.01)
    with pytest.raises(BlockingIOError):
        found.receive()


def test_the_oldest_go_first(monkeypatch: pytest.MonkeyPatch) -> None:
    found = greeted()
    for number in range(5):
        found.put(Incoming(b"x", number), 2)
    assert (found.dropped, found.waiting) == (3, 2)
    monkeypatch.setattr(inbox, "MOST_BYTES", 10)
    found.put(Incoming(b"x" * 9, 9), 100)
    found.put(Incoming(b"x" * 100, 10), 100)  # alone it may be larger than all may be
    assert [found.receive()[0].number for _ in range(found.waiting)] == [10]  # type: ignore[index, attr-defined]


def test_waiting_ends() -> None:
    found, seen = greeted(), []  # type: ignore[var-annotated]
    threads = [threading.Thread(target=lambda: seen.append(found.receive())) for _ in range(2)]
    for thread in threads:
        thread.start()
    found.interrupt()
    for thread in threads:
        thread.join(HANG)
    assert seen == [None, None]
    found.put(Incoming(b"x"), 10)
    assert found.receive() is None


@pytest.mark.parametrize(
    ("problem", "becomes"),
    [(ValueError("oh"), BrokenPipeError), (LocalProtocolError("oh"), LocalProtocolError)],
)
def test_what_cannot_be_sent(problem: Any, becomes: type[Exception]) -> None:
    found = greeted()
    found.send([Outgoing(None, ())])
    with pytest.raises(becomes, match="oh"):
        found.send([Outgoing(problem, ())])
    found.interrupt()
    with pytest.raises(BrokenPipeError, match="closed"):
        found.send([])
