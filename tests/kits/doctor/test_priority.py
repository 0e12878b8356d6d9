"""Findings about priorities; test_examination.py has the fault."""

from support.doctor import made_up

from yarpy.kits.doctor.priority import find
from yarpy.network.traffic import End, Flow
from yarpy.qos import Qos


def test_marks_of_packets_that_were_taken_away() -> None:
    end = End("tcp", qos=Qos(packets="NORM"), asked={"packets": "AF42"})
    [finding] = find(made_up(Flow("/a", "/b", end)))
    assert "asked for AF42 on this connection, and the system gives CS0" in finding.verdict
    assert "`yarpy qos set /a /b --src AF42`" in finding.advice
