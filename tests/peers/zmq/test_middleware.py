"""Decorated methods at a broker of ZeroMQ, beside a program with pyzmq alone."""

from __future__ import annotations

import json

import numpy as np
import pytest
from support.port import free_block
from support.wait import HANG

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.value.tree import to_text
from yarpy.peers.zmq.broker import keep_ready

zmq = pytest.importorskip("zmq")


class Arm:
    @wrap.on("/arm/state", "zeromq", wait=HANG, together=True)
    @wrap.on("/arm/camera", "zeromq")
    def see(self) -> tuple[dict, np.ndarray]:
        return {"angle": 45.0}, np.arange(24, dtype="u1").reshape(2, 4, 3)

    @wrap.on("/arm/word", "zeromq", wait=HANG, keep="all")
    def say(self) -> dict:
        return {"angle": 45.0}

    @wrap.on("/arm/rpc", "zeromq")
    def turn(self, angle: float, by: np.ndarray | None = None) -> float:
        if angle > 90:
            raise ValueError("too far")
        return angle + (0.0 if by is None else float(by.sum()))


@pytest.fixture
def place() -> str:
    return f"zeromq://127.0.0.1:{free_block(2)}"


def test_values_and_questions(place: str) -> None:
    here, there = Arm(), Arm()
    places = {"middleware": place, "encoding": "frame"}
    with wrap.listen(there.see, **places), wrap.publish(here.see, **places) as handle:
        here.see()
        state, picture = there.see(timeout=HANG)
        assert state == {"angle": 45.0} and np.array_equal(picture, here.see()[1])
        assert handle.stats[0]["messages"] == 2 and handle.stats[0]["heard"]
    with wrap.serve(here.turn, middleware=place), wrap.call(there.turn, middleware=place):
        assert there.turn(1, timeout=HANG) == 1
        assert there.turn(1, np.ones(3), timeout=HANG) == 4
        with pytest.raises(wrap.RemoteError, match="ValueError: too far"):
            there.turn(91, timeout=HANG)


def test_programs_without_decorators(place: str) -> None:
    here = Arm()
    number = int(place.rpartition(":")[2])
    with zmq.Context() as context, context.socket(zmq.SUB) as sub, context.socket(zmq.XPUB) as out:
        keep_ready("127.0.0.1", number, number + 1)
        sub.connect(f"tcp://127.0.0.1:{number}")
        sub.subscribe(b"/arm/word")
        with wrap.publish(here.say, middleware=place):
            here.say()
            assert sub.poll(1000 * HANG)
            topic, text = sub.recv_multipart()
            assert topic == b"/arm/word" and json.loads(text) == {"angle": 45.0}
        out.connect(f"tcp://127.0.0.1:{number + 1}")
        with wrap.listen(here.say, topic="/arm/goal", middleware=place):
            while out.recv() != b"\1/arm/goal":
                pass
            out.send_multipart([b"/arm/goal", to_text({"t": (1,)}).encode()])  # as Wrapyfi
            out.send_multipart([b"/arm/goal", b"{timestamp:1.5}", b'{"a": 1}'])
            out.send_multipart([b"/arm/goal", b"a", b"b", b"c"])
            assert here.say(timeout=HANG) == {"t": (1,)}
            assert here.say(timeout=HANG) == {"a": 1}
            with pytest.raises(yarpy.DecodeError, match="3 parts"):
                here.say(timeout=HANG)


def test_options() -> None:
    for wrong in ({"carrier": "udp"}, {"reliable": True}, {"middleware": "zeromq://a:b"}):
        with pytest.raises(ValueError):
            wrap.on("/x", **({"middleware": "zeromq"} | wrong))(lambda: 1)  # type: ignore[arg-type]
