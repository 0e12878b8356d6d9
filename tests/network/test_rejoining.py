"""Another carrier, and everything else as it was."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.system import NO_MARKS
from support.wait import wait_until

import yarpy
from yarpy.network import qos
from yarpy.network.rejoining import give_back, rejoin, settings
from yarpy.qos import Qos

Ports = tuple[yarpy.LocalNames, yarpy.Port, yarpy.BufferedPort]


@pytest.fixture
def ports() -> Iterator[Ports]:
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as in_:
        out.connect("/in", "tcp")
        wait_until(lambda: in_.inputs)
        yield names, out, in_


def carriers(port: yarpy.Port) -> list[str]:
    return [str(link.carrier) for link in port.outputs]


def test_each_end_keeps_what_it_had(ports: Ports) -> None:
    names, out, _ = ports
    qos.grant(
        "/out",
        "/in",
        sender=Qos(packets=None if NO_MARKS else "HIGH", deadline=0.5, late="drop"),
        receiver=Qos(packets=None if NO_MARKS else "LOW", deadline=0.02, rate=50),
        names=names,
    )
    had = settings("/out", "/in", names)
    rejoin("/out", "/in", "fast_tcp", "tcp", names=names)
    assert carriers(out) == ["fast_tcp"]
    assert settings("/out", "/in", names) == had
    with pytest.raises(yarpy.YarpError):
        rejoin("/out", "/in", "pigeon", "fast_tcp", names=names)
    assert carriers(out) == ["fast_tcp"]
    assert settings("/out", "/in", names) == had


def test_what_was_never_set_is_not_set(ports: Ports, monkeypatch: pytest.MonkeyPatch) -> None:
    names, out, _ = ports
    monkeypatch.setattr(
        "yarpy.port.answer.prop.grant_sched", lambda *_: pytest.fail("a thread is set")
    )
    monkeypatch.setattr(
        "yarpy.port.answer.prop.grant_tos", lambda *_: pytest.fail("packets are set")
    )
    rejoin("/out", "/in", "fast_tcp", "tcp", names=names)
    assert carriers(out) == ["fast_tcp"]


def test_what_cannot_be_given_back_is_told(ports: Ports, caplog: pytest.LogCaptureFixture) -> None:
    names, out, _ = ports
    give_back("/out", "/nobody", None, names)
    assert not caplog.records
    out.disconnect("/in")
    give_back("/out", "/in", (Qos(packets="HIGH"), Qos()), names)
    assert "has not the priority it had" in caplog.text


def test_one_that_was_dialled_by_address(ports: Ports) -> None:
    names, out, in_ = ports
    out.disconnect("/in")
    out.connect(f"/{in_.address}/", "tcp")
    wait_until(lambda: [link.source for link in in_.inputs] == ["/out"])
    qos.grant("/out", "/in", sender=Qos(deadline=0.5), names=names)
    rejoin("/out", "/in", "fast_tcp", "tcp", names=names)
    assert carriers(out) == ["fast_tcp"]
    assert out.outputs[0].qos.deadline == 0.5
