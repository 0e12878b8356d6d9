"""stats_monitor: what is told once a second, about messages and about replies."""

from __future__ import annotations

from typing import Any

import pytest
from support.monitor import place
from support.wait import HANG

import yarpy
from yarpy.data.value import Vocab
from yarpy.network.stats_monitor import StatsMonitor


def test_messages_and_replies() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.RpcServer("/b", lambda message: "four", names=names),
        yarpy.RpcClient(name="/a", names=names) as client,
        yarpy.BufferedPort("/there", strict=True, names=names) as there,
        yarpy.BufferedPort("/back", strict=True, names=names) as back,
    ):
        carrier = "tcp+send.stats_monitor"
        client.connect("/b", carrier)
        there.listen_to("/stats_monitor/a/b/stats:o")
        back.listen_to("/stats_monitor/b/a/stats:o")
        for _ in range(10):
            client.call("a question")
        for port, ends, forward in ((there, ["/a", "/b"], "ok"), (back, ["/b", "/a"], "fail")):
            told: list[Any] = []
            while not told or told[-1].value[6] == 0:
                message = port.read(timeout=HANG)
                assert message is not None
                told.append(message)
            _, *facts, size, count = told[-1].value
            assert facts == [*ends, carrier, Vocab(forward)]
            assert 0 < count <= 10
            assert size / count == pytest.approx(22 if forward == "ok" else 20)
        client.disconnect("/b")
        assert names.query("/stats_monitor/a/b/stats:o") is None


def test_only_at_the_senders_end() -> None:
    with pytest.raises(yarpy.LocalProtocolError, match="sender's end"):
        StatsMonitor(place())
