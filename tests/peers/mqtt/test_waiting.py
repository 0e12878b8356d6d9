"""Decorated methods that wait for a server at a broker: what they tell when time is over."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import yarpy
from yarpy.data import codec
from yarpy.peers.mqtt import middleware


@pytest.mark.parametrize(
    ("answers", "slept", "fails"),
    [
        ([0.001, 0.001], 1, yarpy.UnknownName),  # early, and after half the time
        ([0.08], 0, yarpy.UnknownName),  # the next might come too late
        ([0.03, 0.03], 1, yarpy.UnknownName),
        ([0.5], 0, yarpy.Timeout),  # the broker itself is silent
    ],
)
def test_who_waits_for_a_server_hears_that_there_is_none(
    monkeypatch: pytest.MonkeyPatch, answers: list[float], slept: int, fails: type[Exception]
) -> None:
    now, pauses, coming = [100.0], [], list(answers)

    def sleep(seconds: float) -> None:
        pauses.append(seconds)
        now[0] += seconds

    def ask(question: object, timeout: float) -> yarpy.Message:
        took = coming.pop(0)
        now[0] += min(took, timeout)
        if took > timeout:
            raise yarpy.Timeout("the broker did not reply")
        refused = [yarpy.Vocab("fail"), "nobody has subscribed to arm/rpc at the broker"]
        return yarpy.Message("d", b"".join(codec.encode(refused)))

    monkeypatch.setattr(middleware, "time", SimpleNamespace(monotonic=lambda: now[0], sleep=sleep))
    client = object.__new__(middleware.MqttClient)
    client._client = SimpleNamespace(ask=ask)  # type: ignore[assignment]
    with pytest.raises(fails):
        client.call("turn", [1], {}, 0.2)
    assert (coming, len(pauses)) == ([], slept)
