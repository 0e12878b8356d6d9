"""`yarpy sched`: the scheduling of threads."""

import pytest
from support.system import NO_SCHEDULING
from support.wait import wait_until

import yarpy
from yarpy.cli.verbs.sched import parse
from yarpy.qos import Qos


@pytest.fixture
def ports(names):
    with yarpy.Port("/sched/in", names=names) as in_, yarpy.Port("/sched/out", names=names) as out:
        out.connect("/sched/in")
        wait_until(lambda: in_.inputs)
        yield "/sched/out", "/sched/in"


@pytest.mark.skipif(bool(NO_SCHEDULING), reason=NO_SCHEDULING)
def test_get(here, ports):
    assert here("sched", "get", *ports).out == (
        "(src (sched ((policy -1) (priority -1)))) (des (sched ((policy 0) (priority 0))))\n"
    )
    label = here("priority-sched", "get", *ports, "--des", "--policy-label").out
    assert label == "(des (sched ((policy SCHED_OTHER))))\n"
    assert (
        here("sched", "get", *ports, "--des", "--priority").out == "(des (sched ((priority 0))))\n"
    )


def test_set(here, ports, monkeypatch):
    asked = []
    monkeypatch.setattr(
        "yarpy.platform.scheduling.schedule", lambda tid, *granted: asked.append(granted)
    )
    assert here("sched", "set", *ports, "--src", "FIFO:30", "--des", "RR:2") == (0, "", "")
    # The sender's thread is new, and may also ask by itself.
    assert sorted({*asked}) == [(1, 30), (2, 2)]


def test_refused(here, ports, monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr("yarpy.platform.scheduling.schedule", refuse)
    said = here("sched", "set", *ports, "--des", "FIFO:30")
    assert said.code == 1
    assert "the system refuses real-time scheduling: run as" in said.err


@pytest.mark.parametrize(
    ("text", "qos"),
    [
        ("FIFO:30", Qos("SCHED_FIFO", 30)),
        ("sched_rr:1", Qos("SCHED_RR", 1)),
        ("OTHER", Qos("SCHED_OTHER", 0)),
        ("1:30", Qos("SCHED_FIFO", 30)),
        ("POL:1", Qos("SCHED_FIFO", 1)),
        ("POL:SCHED_RR", Qos("SCHED_RR", 1)),
        ("PRT:30", Qos(priority=30)),
    ],
)
def test_values(text, qos):
    assert parse(text) == qos


@pytest.mark.parametrize("value", ["FIFO:100", "LIFO:3", "FIFO:x", "POL:7", "OTHER:5"])
def test_wrong_values(here, ports, value):
    said = here("sched", "set", *ports, "--src", value)
    assert said.code == 1
    assert "FIFO:30" in said.err


def test_describe(here):
    assert "1 SCHED_FIFO: priority 1 to 99" in here("sched", "describe").out
