"""The answer to [stat]."""

from __future__ import annotations

from support.system import NO_MARKS, NO_SCHEDULING
from support.wait import HANG, wait_until

import yarpy
from yarpy import registry
from yarpy.data.bottle import Property
from yarpy.network.traffic import read
from yarpy.port.answer.report import report
from yarpy.port.connect import probe


class Level:
    def __init__(self, place: object) -> None:
        pass

    def parameters(self) -> dict[str, object]:
        return {"level": 3}

    def state(self) -> dict[str, object]:
        return {"filled": 0.5}


def test_every_connection_with_a_port_and_no_visitor() -> None:
    registry.monitors.add("level", Level)
    names = yarpy.LocalNames()
    try:
        with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
            out.connect("/in", "tcp+recv.level")
            for number in range(3):
                out.write([number])
                in_.read(timeout=HANG)
            if not NO_MARKS:
                out.outputs[0].qos = yarpy.Qos(packets="HIGH")
            wait_until(lambda: in_.inputs[0].stats.messages == 3)
            [sent] = map(Property.from_bottle, probe.ask(out._hub.contact, ["stat"]))
            [came] = map(Property.from_bottle, probe.ask(in_._hub.contact, ["stat"]))
            assert (sent["side"], came["side"]) == ("out", "in")
            assert read(sent)[:2] == read(came)[:2] == ("/out", "/in")
            end = read(sent)[2]
            assert (end.carrier, end.messages, end.drops) == ("tcp+recv.level", 3, 0)
            assert end.qos == yarpy.Qos(packets="CS0" if NO_MARKS else "HIGH")
            assert end.latency is None
            end = read(came)[2]
            assert came["received"] == 3
            question = ["stat", "in", "/out"]
            [alone] = map(Property.from_bottle, probe.ask(in_._hub.contact, question))
            assert (alone["source"], alone["received"]) == ("/out", 3)
            assert probe.ask(in_._hub.contact, ["stat", "in", "/other"]) == []
            assert (end.monitors, end.parameters) == (["level"], {"level": 3})
            assert end.state == {"filled": 0.5}
            assert end.qos.policy == (None if NO_SCHEDULING else "SCHED_OTHER")
    finally:
        registry.monitors.remove("level")


def test_a_port_alone() -> None:
    with yarpy.Port("/it", names=yarpy.LocalNames()) as port:
        assert report(port._hub) == []


def test_what_the_doctor_asks_for() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/in", names=names) as in_,
        yarpy.Port("/out", names=names) as out,
        yarpy.Port("/back", names=names, callback=lambda message: message.as_(yarpy.Image)) as back,
    ):
        out.connect("/in")
        out.connect("/back")
        for number in range(3):
            out.write([number], wait=True)
        wait_until(lambda: back.inputs and back.inputs[0].stats.drops == 3)
        [told] = report(in_._hub)
        assert (told["delivered"], told["waiting"], told["lost"]) == (1, 1, 0)
        [told] = report(back._hub)
        assert "expected an Image" in told["failure"]
        sent = report(out._hub)[0]
        assert sent["unacknowledged"] == 0
        assert "asked" not in sent
        link = out._hub.outputs.links[0]
        link.asked = yarpy.Qos(packets="CRIT")  # and somebody else has set the socket since
        assert report(out._hub)[0]["asked"] == {"packets": "VA"}
        in_.attach("in", {"monitor": "throttleDown", "period_ms": 100000})
        for number in range(3):
            out.write([number], wait=True)
        [told] = report(in_._hub)
        assert (told["port_monitor"], told["port_dropped"]) == ("ThrottleDown", 2)
