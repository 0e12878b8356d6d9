"""Decorated methods over a router of Zenoh, beside a program with eclipse-zenoh alone."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support.port import free_port
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.middleware import Binding
from yarpy.peers.zenoh import transport as sessions
from yarpy.peers.zenoh.middleware import ZenohClient, key_of
from yarpy.peers.zenoh.router import open_router

pytest.importorskip("zenoh")


class Arm:
    @wrap.on("/arm/state", "zenoh", wait=HANG, keep="all")
    def state(self) -> dict:
        return {"angle": 45.0}

    @wrap.on("/arm/camera", "zenoh", wait=HANG)
    def camera(self) -> np.ndarray:
        return np.arange(24, dtype="u1").reshape(2, 4, 3)

    @wrap.on("/arm/rpc", "zenoh")
    def turn(self, angle: float, by: np.ndarray | None = None) -> float:
        if angle > 90:
            raise ValueError("too far")
        return angle + (0.0 if by is None else float(by.sum()))


@pytest.fixture(scope="module")
def place() -> Iterator[str]:
    where = f"tcp/127.0.0.1:{free_port()}"
    router = open_router([where])
    yield where
    sessions.close(router)


def test_values(place: str) -> None:
    here, there, middleware = Arm(), Arm(), f"zenoh://{place}"
    with wrap.listen(there.camera, middleware=middleware):
        with pytest.raises(yarpy.Timeout):
            there.camera(timeout=0.01)
        with wrap.publish(here.camera, middleware=middleware) as handle:
            sent = here.camera()
            assert np.array_equal(there.camera(timeout=HANG), sent)
            assert handle.stats[0]["messages"] == 1


def test_programs_without_decorators(place: str) -> None:
    here, middleware = Arm(), f"zenoh://{place}"
    with sessions.share(place) as shared, wrap.listen(here.state, middleware=middleware):

        def sent() -> bool:
            shared.session.put("arm/state", b'{"angle": 1}')
            try:
                return here.state(timeout=0.1) == {"angle": 1}
            except yarpy.Timeout:
                return False

        wait_until(sent)
        picture = b'{"timestamp": 1.5, "shape": [2, 2], "dtype": "uint8"}\n1234'  # as Wrapyfi
        shared.session.put("arm/state", picture)
        with pytest.raises(yarpy.DecodeError, match="expected a dict"):
            for _ in range(100):
                here.state(timeout=HANG)


def test_questions(place: str) -> None:
    here, there, middleware = Arm(), Arm(), f"zenoh://{place}"
    with wrap.call(there.turn, middleware=middleware):
        for options in ({}, {"timeout": 0.2}):
            with pytest.raises(yarpy.UnknownName, match="nobody serves"):
                there.turn(1, **options)
        with wrap.serve(here.turn, middleware=middleware):
            assert there.turn(1, timeout=HANG) == 1
            assert there.turn(1, np.ones(3)) == 4
            with pytest.raises(wrap.RemoteError, match="ValueError: too far"):
                there.turn(91)


def test_nobody_is_told_of_late(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The library took all the time there was, as it does on a busy computer."""
    monkeypatch.setattr(ZenohClient, "_ask", lambda self, question, deadline: (None, True))
    here, there, middleware = Arm(), Arm(), f"zenoh://{place}"
    with wrap.call(there.turn, middleware=middleware):
        with pytest.raises(yarpy.UnknownName, match="nobody serves"):
            there.turn(1, timeout=0.2)
        with (
            wrap.serve(here.turn, middleware=middleware),
            pytest.raises(yarpy.Timeout, match="did not answer"),
        ):
            there.turn(1, timeout=HANG)


def test_a_server_that_comes_later(place: str) -> None:
    here, there, middleware = Arm(), Arm(), f"zenoh://{place}"
    with wrap.call(there.turn, middleware=middleware), ThreadPoolExecutor(1) as other:
        answer = other.submit(there.turn, 1, timeout=HANG)
        with pytest.raises(TimeoutError):
            answer.result(0.3)
        with wrap.serve(here.turn, middleware=middleware):
            assert answer.result(HANG) == 1


SERVER = """
import os, sys
from yarpy import wrap

class Arm:
    @wrap.on("/arm/rpc", "zenoh://" + sys.argv[1])
    def turn(self, angle: float) -> float:
        if angle == 0:
            os._exit(1)
        while True:
            sys.stdin.read()

arm = Arm()
wrap.serve(arm.turn)
print("ready", flush=True)
sys.stdin.read()
"""


@pytest.mark.parametrize("options", [{}, {"timeout": HANG}])
def test_a_server_that_dies(place: str, options: dict[str, float]) -> None:
    there = Arm()
    with Process([sys.executable, "-c", SERVER, place]) as server:
        server.wait_line("ready", timeout=HANG, stream="out")
        with (
            wrap.call(there.turn, middleware=f"zenoh://{place}"),
            pytest.raises(yarpy.LinkClosed, match="went away during the call"),
        ):
            there.turn(0, **options)


def test_a_server_that_is_slow(place: str) -> None:
    there = Arm()
    with Process([sys.executable, "-c", SERVER, place]) as server:
        server.wait_line("ready", timeout=HANG, stream="out")
        with (
            wrap.call(there.turn, middleware=f"zenoh://{place}"),
            pytest.raises(yarpy.Timeout, match="did not answer"),
        ):
            there.turn(1, timeout=0.5)


def test_keys() -> None:
    assert key_of(Binding("/arm/state/")) == "arm/state"
    for wrong in ("/", "a//b", "a/*"):
        with pytest.raises(ValueError, match="no key of Zenoh"):
            key_of(Binding(wrong))
