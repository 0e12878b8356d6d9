"""`yarpy qos`: the priority of packets."""

import time

import pytest
from support.system import NO_MARKS
from support.wait import wait_until

import yarpy


@pytest.fixture(scope="module")
def ports(names):
    with yarpy.Port("/qos/in", names=names) as in_, yarpy.Port("/qos/out", names=names) as out:
        out.connect("/qos/in")
        wait_until(lambda: in_.inputs)
        yield "/qos/out", "/qos/in"


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_set_and_get(here, ports):
    assert here("qos", "set", *ports, "--src", "HIGH", "--des", "DSCP:AF11") == (0, "", "")
    assert here("qos", "get", *ports).out == "(src (qos ((tos 144)))) (des (qos ((tos 40))))\n"
    assert here("qos", "get", *ports, "--src", "--dscp").out == "(src (qos ((dscp AF42))))\n"
    level = here("priority-qos", "get", *ports, "--level").out
    assert level == "(src (qos ((level HIGH)))) (des (qos ((level LOW))))\n"
    for value in ("TOS:0", "0", "LEVEL:NORM", "DSCP:0"):
        assert here("qos", "set", *ports, "--src", value).code == 0
        assert here("qos", "get", *ports, "--src").out == "(src (qos ((tos 0))))\n"


@pytest.mark.parametrize("value", ["WOW", "DSCP:64", "TOS:256", "LEVEL:9", "TOS:x", "X:1", ""])
def test_wrong_values(here, ports, value):
    said = here("qos", "set", *ports, "--src", value)
    assert (said.code, said.out) == (1, "")
    assert "error" in said.err


def test_who_is_not_there(here, ports):
    assert "no connection" in here("qos", "get", ports[0], "/nobody").err
    assert here("qos", "get", "/nobody", ports[0]).code == 1
    assert "--src VALUE" in here("qos", "set", *ports).err


def test_describe(here):
    assert "HIGH  DSCP 36 TOS 144" in here("qos", "describe").out
    assert here("qos", "describe", "CRIT").out == "(tos 176) (dscp VA) (level CRITICAL)\n"


def test_when_messages_should_come(here, ports):
    assert here("qos", "time", *ports).out == '"/qos/in" expects nothing of "/qos/out"\n'
    said = here("qos", "time", *ports, "--deadline", "0.02", "--rate", "50", "--late", "drop")
    assert said.out.startswith("(deadline 0.02) (rate 50) (late drop) (missed ")
    assert here("qos", "time", *ports, "--deadline", "0", "--rate", "0").code == 0
    assert "expects nothing" in here("qos", "time", *ports).out
    said = here("qos", "time", *ports, "--deadline", "-1")
    assert (said.code, "from 0 to 86400" in said.err) == (1, True)


def test_what_the_sender_dropped_is_counted_too(here, names):
    with (
        yarpy.BufferedPort("/qos/late/in", strict=True, names=names) as in_,
        yarpy.Port("/qos/late/out", names=names) as out,
    ):
        out.connect("/qos/late/in")
        wait_until(lambda: in_.inputs)
        ends = "/qos/late/out", "/qos/late/in"
        assert here("qos", "time", *ends, "--deadline", "600", "--late", "drop").code == 0
        for number in range(3):
            out.write([number], yarpy.Stamp(number, time.time() - 1000))
        assert "(missed 0) (dropped 3) " in here("qos", "time", *ends).out
