"""Pings: who gets one, when, and that nothing waits for it."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import wait_until

import yarpy
from yarpy.carriers.base import Limits
from yarpy.port.answer import ping


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Any:
    found = SimpleNamespace(now=0.0)
    monkeypatch.setattr(ping, "time", SimpleNamespace(monotonic=lambda: found.now))
    return found


def test_each_connection_gets_one_in_its_time(clock: Any) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as inlet:
        out.connect("/in")
        (link,), hubs = out._hub.outputs.links, [out._hub]
        pings = ping.Pings()
        pings.look(hubs)
        before = link.driver.bytes_out
        clock.now = 1000.0
        pings.look(hubs)
        assert link.driver.bytes_out == before  # YARP wants none
        link.carrier.limits = Limits(ping=b"~\0\0\0\1~\0\0", ping_interval=5.0)
        try:
            for clock.now, sent in (
                (1001.0, 0),
                (1005.9, 0),
                (1006.1, 8),
                (1010.0, 8),
                (1011.2, 16),
            ):
                pings.look(hubs)
                assert link.driver.bytes_out == before + sent
            with link.sender.lock:  # somebody sends
                clock.now = 1020.0
                link.driver.bytes_in += 1  # the peer has said something
                pings.look(hubs)
                assert link.driver.bytes_out == before + 16
            pings.look(hubs)
            assert link.driver.bytes_out == before + 24
        finally:
            link.carrier.limits = Limits()
        out.disconnect("/in")
        wait_until(lambda: not inlet.inputs)
        pings.look(hubs)
        assert not pings._turns


def test_whoever_waits_for_an_answer_pings(clock: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    asked, answered = threading.Event(), threading.Event()

    def answer(message: yarpy.Message) -> int:
        asked.set()
        answered.wait(60)
        return 7

    names = yarpy.LocalNames()
    with (
        yarpy.RpcServer("/server", answer, names=names),
        yarpy.RpcClient("/server", names=names) as client,
        ThreadPoolExecutor(1) as other,
    ):
        (link,), hubs = client._hub.outputs.links, [client._hub]
        link.carrier.limits = Limits(ping=b"~\0\0\0\1~\0\0", ping_interval=5.0)
        pings = ping.Pings()
        pings.look(hubs)
        answer_ = other.submit(client.call, 1)
        try:
            assert asked.wait(60)
            wait_until(lambda: link.sender.listens)
            before = link.driver.bytes_out
            clock.now = 6.0
            pings.look(hubs)
            assert link.driver.bytes_out == before + 8
        finally:
            answered.set()
        assert answer_.result(60) == 7
        assert not link.sender.listens
