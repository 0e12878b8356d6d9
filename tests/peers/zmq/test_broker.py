"""The broker of ZeroMQ: one at a time, another's turn when it ends, and what it tells."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from support.port import free_block
from support.wait import HANG

zmq = pytest.importorskip("zmq")

from yarpy.peers.zmq.broker import MONITOR, Broker, keep_ready  # noqa: E402


@pytest.fixture
def context() -> Iterator[zmq.Context]:  # type: ignore[name-defined]
    with zmq.Context() as found:
        yield found


def test_programs_meet_and_the_broker_tells_who_listens(context: zmq.Context) -> None:  # type: ignore[name-defined]
    number = free_block(2)
    broker = Broker("127.0.0.1", number, number + 1)
    sub, out = context.socket(zmq.SUB), context.socket(zmq.XPUB)
    sub.connect(f"tcp://127.0.0.1:{number}")
    sub.subscribe(MONITOR)
    sub.subscribe(b"/a")
    seen = {}
    while seen.get("/a") != 1:
        assert sub.poll(1000 * HANG)
        topic, text = sub.recv_multipart()
        assert topic == MONITOR
        seen = json.loads(text)
    out.connect(f"tcp://127.0.0.1:{number + 1}")
    assert out.poll(1000 * HANG)  # a subscription
    out.send_multipart([b"/a", b"1", b"2"])
    assert sub.poll(1000 * HANG) and sub.recv_multipart() == [b"/a", b"1", b"2"]
    sub.unsubscribe(b"/a")
    while seen.get("/a") != 0:
        assert sub.poll(1000 * HANG)
        seen = json.loads(sub.recv_multipart()[1])
    sub.close(), out.close(), broker.close()


def test_another_takes_over() -> None:
    number = free_block(2)
    first, second = (Broker("127.0.0.1", number, number + 1) for _ in range(2))
    assert first.bound.is_set() and not second.bound.is_set()
    first.close()
    assert second.bound.wait(HANG)
    second.close()


def test_broker_of_another_computer_is_left_to_it() -> None:
    broker = Broker("203.0.113.7", 5555, 5556)
    broker._thread.join(HANG)
    assert not broker._thread.is_alive() and not broker.bound.is_set()


def test_one_for_each_place() -> None:
    number = free_block(2)
    assert keep_ready("127.0.0.1", number, number + 1) is keep_ready(
        "127.0.0.1", number, number + 1
    )
    keep_ready("127.0.0.1", number, number + 1).close()
