"""Both ends of a connection are shown and set, or the one that is asked for."""

import click
import pytest
from support.system import NO_MARKS
from support.wait import HANG

import yarpy
from yarpy.cli.ends import grant, of_a_connection, show
from yarpy.qos import Qos


@pytest.fixture(autouse=True)
def connected():
    with (
        yarpy.NameServer(),
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in") as in_,
    ):
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        yield


def spell(qos: Qos) -> str:
    return f"(tos {qos.tos})"


def test_one_end_or_both():
    assert show("/out", "/in", None, spell) == "(src (tos 0)) (des (tos 0))"
    assert show("/out", "/in", "des", spell) == "(des (tos 0))"


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_only_what_is_said_is_set():
    grant("/out", "/in", "36", None, lambda text: Qos(packets=int(text)))
    assert show("/out", "/in", None, spell) == "(src (tos 144)) (des (tos 0))"
    with pytest.raises(click.UsageError, match="at which end"):
        grant("/out", "/in", None, None, lambda text: Qos())


def test_arguments_and_options_in_their_order():
    @click.command()
    @of_a_connection
    def command(source, target, side):
        return source, target, side

    assert command.main(["/a", "/b", "--des"], standalone_mode=False) == ("/a", "/b", "des")
    assert command.main(["/a", "/b"], standalone_mode=False) == ("/a", "/b", None)
