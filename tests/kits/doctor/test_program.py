"""Findings about programs; test_examination.py has the faults."""

from support.doctor import answering, made_up

from yarpy.kits.doctor.program import find


def test_a_port_that_lets_nobody_ask() -> None:
    case = made_up(ports=(answering("/a", state="denied", error="you may not"),), wanted=("/a",))
    [finding] = find(case)
    assert (finding.probe, "you may not" in finding.verdict) == ("denied", True)


def test_a_silent_port_elsewhere() -> None:
    [finding] = find(made_up(ports=(answering("/a", state="silent"),), wanted=("/a",)))
    assert (finding.probe, "kill -CONT PID" in finding.advice) == ("hangs", True)
