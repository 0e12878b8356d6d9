"""Topics at a broker in frames, questions and answers, and what ends while somebody waits."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from support.patience import patience
from support.port import free_block
from support.wait import wait_until

import yarpy

pytest.importorskip("zmq")

from yarpy.wrap.zmq_broker import Broker
from yarpy.wrap.zmq_link import Answerer, Caller, In, Out, parse_place

PATIENCE = patience(10.0)


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
    assert out.wait(PATIENCE) and longer.wait(PATIENCE)  # a prefix of it is subscribed to
    longer.send([b"other"])
    assert out.send([b"1", b"2"]) == 1
    assert into.receive(PATIENCE) == [b"1", b"2"]
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
    assert out.wait(PATIENCE)
    time.sleep(0.2)  # of two subscriptions the broker tells once
    for number in range(5):
        out.send([b"%d" % number])
    assert [every.receive(PATIENCE) for _ in range(5)][-1] == [b"4"]
    wait_until(lambda: newest.receive(PATIENCE) == [b"4"])
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
            gate.wait(PATIENCE)
        return [b"to", *frames]

    server = Answerer("/ask", sub, pub, answer)
    assert caller.ask([b"1", b"2"], PATIENCE) == [b"to", b"1", b"2"]
    with pytest.raises(yarpy.Timeout, match="did not answer"):
        caller.ask([b"late"], 0.05)
    gate.set()
    assert caller.ask([b"3"], PATIENCE) == [b"to", b"3"]  # not the answer that came too late
    caller.close(), server.close()


def test_server_that_goes_away_in_the_middle_of_a_call(places: tuple[str, str]) -> None:
    pub, sub = places
    asked = In("/ask?", pub)  # reads the question, and says nothing
    caller = Caller("/ask", sub, pub)

    def leave() -> None:
        asked.receive(PATIENCE)
        asked.close()

    thread = threading.Thread(target=leave)
    thread.start()
    with pytest.raises(yarpy.LinkClosed, match="went away"):
        caller.ask([b"1"], None)
    thread.join(PATIENCE)
    caller.close()


def test_places() -> None:
    assert parse_place("") == ("127.0.0.1", 5555)
    assert parse_place("host") == ("host", 5555) and parse_place("host:7") == ("host", 7)
    with pytest.raises(ValueError, match="no place of a broker"):
        parse_place("host:x")
