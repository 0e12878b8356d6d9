"""Topics at a broker in frames, questions and answers, and what ends while somebody waits."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import suppress

import pytest
from support.port import free_block
from support.wait import HANG, wait_until

import yarpy

pytest.importorskip("zmq")

from yarpy.peers.zmq.broker import Broker
from yarpy.peers.zmq.link import Answerer, Caller, In, Out, parse_place


@pytest.fixture
def places() -> Iterator[tuple[str, str]]:
    """Where to subscribe, and where to publish."""
    number = free_block(2)
    broker = Broker("127.0.0.1", number, number + 1)
    yield f"tcp://127.0.0.1:{number}", f"tcp://127.0.0.1:{number + 1}"
    broker.close()


def test_first_value_is_not_lost_and_topics_are_whole_frames(places: tuple[str, str]) -> None:
    pub, sub = places
    out, longer = Out("/t", sub), Out("/tt", sub)
    assert not out.wait(0.01) and not out.heard
    into = In("/t", pub)
    assert out.wait(HANG) and longer.wait(HANG)  # a prefix of it is subscribed to
    longer.send([b"other"])
    assert out.send([b"1", b"2"]) == 1
    assert into.receive(HANG) == [b"1", b"2"]
    with pytest.raises(yarpy.Timeout):
        into.receive(0.01)
    into.close()
    wait_until(lambda: not out.heard)
    out.close(), longer.close()
    for act in (lambda: out.send([b"x"]), lambda: out.wait(0), lambda: into.receive(0)):
        with pytest.raises(yarpy.PortClosed):
            act()


def test_newest_alone(places: tuple[str, str]) -> None:
    pub, sub = places
    out, every, newest = Out("/t", sub), In("/t", pub), In("/t", pub, newest=True)

    def is_heard(into: In) -> bool:
        out.send([b"early"])
        with suppress(yarpy.Timeout):
            return bool(into.receive(0.05))
        return False

    for into in (every, newest):  # of two subscriptions the broker tells once
        wait_until(lambda into=into: is_heard(into))  # type: ignore[misc]
    for number in range(5):
        out.send([b"%d" % number])
    heard = iter(lambda: every.receive(HANG), [b"4"])
    assert [one for one in heard if one != [b"early"]] == [[b"%d" % one] for one in range(4)]
    wait_until(lambda: newest.receive(HANG) == [b"4"])
    for one in (out, every, newest):
        one.close()


def test_closing_ends_waiting(places: tuple[str, str]) -> None:
    into = In("/t", places[0])
    threading.Timer(0.05, into.close).start()
    with pytest.raises(yarpy.PortClosed):
        into.receive(None)


def test_questions(places: tuple[str, str]) -> None:
    pub, sub = places
    caller = Caller("/ask", sub, pub)
    with pytest.raises(yarpy.UnknownName, match="nobody serves"):
        caller.ask([b"1"], 0.01)
    gate = threading.Event()

    def answer(frames: list[bytes]) -> list[bytes]:
        if frames == [b"late"]:
            gate.wait(HANG)
        return [b"to", *frames]

    server = Answerer("/ask", sub, pub, answer)
    assert caller.ask([b"1", b"2"], HANG) == [b"to", b"1", b"2"]
    with pytest.raises(yarpy.Timeout, match="did not answer"):
        caller.ask([b"late"], 0.05)
    gate.set()
    assert caller.ask([b"3"], HANG) == [b"to", b"3"]  # not the answer that came too late
    caller.close(), server.close()


def test_nothing_is_asked_before_an_answer_can_come(places: tuple[str, str]) -> None:
    """A PUB drops what nobody wants as far as it knows, and a question is asked once."""
    pub, sub = places
    asked, caller = In("/ask?", pub), Caller("/ask", sub, pub)
    seen: list[list[bytes]] = []

    def serve() -> None:
        out = None
        while not seen or len(seen[-1]) == 1:  # until the question
            reply_to, *frames = asked.receive(HANG)
            seen.append(frames)
            if len(seen) > 2:  # the first answers are lost
                out = out or Out(reply_to.decode(), sub)
                assert out.wait(HANG) and out.send(frames)
        assert out is not None
        out.close()

    thread = threading.Thread(target=serve)
    thread.start()
    assert caller.ask([b"only once"], HANG) == [b"only once"]
    thread.join(HANG)
    # On a busy machine the first answer that is sent may come too late.
    assert len(seen) >= 4 and seen == [[b"1"]] * (len(seen) - 1) + [[b"2", b"only once"]]
    caller.close(), asked.close()


def test_server_that_goes_away_in_the_middle_of_a_call(places: tuple[str, str]) -> None:
    pub, sub = places
    asked = In("/ask?", pub)  # reads the question, and says nothing
    caller = Caller("/ask", sub, pub)

    def leave() -> None:
        asked.receive(HANG)
        asked.close()

    thread = threading.Thread(target=leave)
    thread.start()
    with pytest.raises(yarpy.LinkClosed, match="went away"):
        caller.ask([b"1"], None)
    thread.join(HANG)
    caller.close()


def test_places() -> None:
    assert parse_place("") == ("127.0.0.1", 5555)
    assert parse_place("host") == ("host", 5555) and parse_place("host:7") == ("host", 7)
    with pytest.raises(ValueError, match="no place of a broker"):
        parse_place("host:x")


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="a thread gets no signals here")
def test_a_signal_handler_closes_what_the_frame_beneath_waits_in(places: tuple[str, str]) -> None:
    """It used to wait for ever for a lock of that frame."""
    pub, sub = places
    for end, wait in (
        (out := Out("/t", sub), lambda: out.wait(HANG)),
        (into := In("/other", pub), lambda: into.receive(HANG)),
    ):
        refused: list[object] = []

        def handle(*_: object, end: Out | In = end, refused: list[object] = refused) -> None:
            with pytest.raises(yarpy.LocalProtocolError, match="beneath a signal handler"):
                end.send([b"1"]) if isinstance(end, Out) else end.receive(0.0)
            refused.append(True)
            end.close()

        before = signal.signal(signal.SIGUSR1, handle)
        me = threading.get_ident()
        timer = threading.Timer(0.05, signal.pthread_kill, (me, signal.SIGUSR1))
        try:
            timer.start()
            with pytest.raises(yarpy.PortClosed):
                wait()
        finally:
            timer.join()
            signal.signal(signal.SIGUSR1, before)
        assert refused
        end.close()
