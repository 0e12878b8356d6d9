"""Events of QoS: counted, and told."""

import threading

import pytest
from support.wait import HANG

from yarpy.peers.ros2.event import CHANGED, MESSAGE, Event, Events


def test_counted_and_told(caplog: pytest.LogCaptureFixture) -> None:
    events, heard = Events(), []
    events.tell(Event(MESSAGE, 3))
    events.hear = heard.append
    events.tell(Event(MESSAGE, 2))
    events.tell(Event(CHANGED, 0))
    assert heard == [(MESSAGE, 2, ""), (CHANGED, 0, "")]
    assert events.counts == {MESSAGE: 5, CHANGED: 1}

    def fail(event: Event) -> None:
        raise ValueError("of the test")

    events.hear = fail
    events.tell(Event(MESSAGE, 1))
    assert "what hears of message_lost failed" in caplog.text

    def leave(event: Event) -> None:
        raise SystemExit(3)

    events.hear = leave
    thread = threading.Thread(target=events.tell, args=(Event(MESSAGE, 1),))
    thread.start()
    thread.join(HANG)
    assert "sys.exit() in a thread of a port ends no program" in caplog.text
