"""Connection files."""

import pytest
from support.system import NO_MARKS
from support.wait import wait_until

import yarpy
from yarpy.cli.wiring import Wire, read
from yarpy.qos import Qos

GOOD = """
[first]
from /wiring/out
to /wiring/in
carrier fast_tcp
sender (qos HIGH)

// a comment
[second]
from /wiring/out
to /wiring/other
sender (sched FIFO 30) (qos AF12)
receiver (sched OTHER) (deadline 0.02) (rate 50) (late drop)
"""


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "connections.ini"
        path.write_text(text)
        return path

    return write


def test_read(file):
    first, second = read(file(GOOD))
    assert first == Wire("/wiring/out", "/wiring/in", "fast_tcp", Qos(packets="HIGH"), None)
    assert (second.carrier, second.target) == ("tcp", "/wiring/other")
    assert (second.sender, second.receiver) == (
        Qos("SCHED_FIFO", 30, "AF12"),
        Qos("SCHED_OTHER", deadline=0.02, rate=50, late="drop"),
    )


WRONG = [
    ("", "names no connections"),
    ("from /a\n", "outside of any"),
    ("[c]\nfrom /a\n", "needs from and to"),
    ("[c]\nfrom /a\nto /b\ncarier tcp\n", "carier"),
    ("[c]\nfrom /a\nto /b\ncarrier tpc\n", 'did you mean "tcp"'),
    ("[c]\nfrom /a\nto /b\nsender (qos WOW)\n", "WOW"),
    ("[c]\nfrom /a\nto /b\nsender (sched FIFO 100)\n", "1 to 99"),
    ("[c]\nfrom /a\nto /b\nsender (speed 3)\n", "sender takes"),
    ("[c]\nfrom /a\nto /b\nsender HIGH\n", "sender takes"),
]


@pytest.mark.parametrize(("text", "complaint"), WRONG)
def test_what_is_wrong_is_said_before_anything_is_connected(file, text, complaint, here):
    said = here("connect", "--file", str(file(GOOD.replace("/wiring", "/nobody") + text)))
    if text and "outside" not in complaint:
        assert (said.code, said.out) == (1, "")
    said = here("connect", "--file", str(file(text)))
    assert (said.code, said.out) == (1, "")
    assert complaint in said.err


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_connect(file, here, names):
    with (
        yarpy.Port("/wiring/in", names=names) as in_,
        yarpy.Port("/wiring/out", names=names) as out,
    ):
        text = GOOD.partition("//")[0]
        said = here("connect", "--file", str(file(text)))
        assert said == (0, "Connected /wiring/out to /wiring/in using fast_tcp\n", "")
        wait_until(lambda: in_.inputs)
        assert out.outputs[0].qos.packets == "AF42"


def test_one_that_fails_does_not_keep_the_others(file, here, names):
    with yarpy.Port("/wiring/in", names=names), yarpy.Port("/wiring/out", names=names) as out:
        text = "[a]\nfrom /wiring/none\nto /wiring/in\n" + GOOD.partition("//")[0]
        said = here("connect", "--file", str(file(text)))
        assert said.code == 1
        assert "/wiring/none" in said.err
        assert len(out.outputs) == 1
