"""In-process pipes: two ends meet by number, objects pass, either side may end it."""

from __future__ import annotations

import threading
import time

import pytest
from support.wait import HANG

from yarpy.errors import RemoteProtocolError
from yarpy.transports import inproc
from yarpy.transports.inproc import MEETING, InprocTransport, open_inproc

NEAR, FAR = ("127.0.0.1", 47000), ("127.0.0.1", 21000)


def meet() -> tuple[InprocTransport, InprocTransport]:
    dialling = open_inproc(False, NEAR, FAR)
    accepting = open_inproc(True, FAR, NEAR)
    dialling.ready()
    accepting.ready()
    return dialling, accepting


def test_objects_pass_both_ways_in_order() -> None:
    near, far = meet()
    things: list[object] = [object(), None, (), [1]]
    near.send(things)
    assert [far.receive() for _ in things] == [(thing,) for thing in things]
    far.send([things])
    found = near.receive()
    assert found is not None
    assert found[0] is things
    near.close()


def test_stranger_finds_nobody() -> None:
    with pytest.raises(RemoteProtocolError, match="one process"):
        open_inproc(True, FAR, ("127.0.0.1", 47001))


def test_peer_that_never_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inproc, "TIMEOUT", 0.05)
    end = open_inproc(False, NEAR, FAR)
    with pytest.raises(TimeoutError):
        end.ready()
    assert MEETING.find((NEAR[1], FAR[1])) is None  # it does not wait there any more


def test_meeting_is_used_once() -> None:
    near, far = meet()
    with pytest.raises(RemoteProtocolError):
        open_inproc(True, FAR, NEAR)
    near.close()
    far.close()


def test_end_is_seen_and_stays() -> None:
    near, far = meet()
    near.send(["last"])
    near.close()
    near.close()
    assert far.ended()
    assert far.receive() == ("last",)
    assert far.receive() is None
    assert far.receive() is None
    with pytest.raises(BrokenPipeError):
        far.send(["to nobody"])
    with pytest.raises(BrokenPipeError):
        near.send(["from nobody"])


def test_waiting_has_a_limit() -> None:
    near, far = meet()
    far.limit_waiting(0.02)
    with pytest.raises(BlockingIOError):
        far.receive()
    with pytest.raises(BlockingIOError):
        near.receive(wait=False)
    far.limit_waiting(None)
    threading.Timer(0.05, near.send, (["late"],)).start()
    assert far.receive() == ("late",)
    near.close()


def test_interrupt_wakes_who_waits() -> None:
    near, far = meet()
    found: list[object] = []
    thread = threading.Thread(target=lambda: found.append(far.receive()))
    thread.start()
    time.sleep(0.02)
    far.interrupt()
    thread.join(HANG)
    assert found == [None]
    near.close()


def test_carries_objects_only() -> None:
    near, far = meet()
    with pytest.raises(TypeError, match="objects"):
        near.recv_into(memoryview(bytearray(1)))
    assert near.try_recv_into(memoryview(bytearray(1))) == -1
    near.set_dscp(8)  # no packets, nothing to do
    near.close()
    far.close()


def test_an_end_that_hears_that_nobody_comes_leaves_the_meeting_place() -> None:
    end = open_inproc(False, NEAR, FAR)

    def look() -> None:
        raise RemoteProtocolError("not here")

    with pytest.raises(RemoteProtocolError, match="not here"):
        end.ready(look)
    assert MEETING.find((NEAR[1], FAR[1])) is None


def test_each_object_is_read_or_refused_when_the_reader_ends_in_the_middle() -> None:
    """Whatever moment it chooses: who sends knows what was taken."""
    for _ in range(100):
        near, far = meet()
        sent: list[int] = []

        def send(near: InprocTransport = near, sent: list[int] = sent) -> None:
            try:
                for number in range(1 << 30):
                    near.send([number])
                    sent.append(number)
            except BrokenPipeError:
                pass

        thread = threading.Thread(target=send)
        thread.start()
        read = [far.receive() for _ in range(3)]
        far.interrupt()
        while (item := far.receive()) is not None:
            read.append(item)
        far.close()
        thread.join(HANG)
        assert read == [(number,) for number in sent]
        near.close()


def test_an_end_that_closes_knows_what_it_has_not_read() -> None:
    near, far = meet()
    near.send([1, 2, 3])
    assert far.receive() == (1,)
    far.interrupt()
    far.close()
    assert far.unread() == [2, 3]
    assert far.unread() == []
    assert far.receive() is None
    with pytest.raises(BrokenPipeError):
        near.send([4])
    near.close()
