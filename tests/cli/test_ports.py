"""Ports that commands open."""

import signal
import time

import click
import pytest
from support.wait import HANG

import yarpy
from yarpy.cli import signals
from yarpy.cli.ports import hear_from, open_another, open_port, send_to


@pytest.fixture(autouse=True)
def context(here):
    """Those of a command: with the environment of this file's server, and its own log."""
    with click.Context(click.Command("test")) as context:
        yield context


def test_with_a_name_server(names):
    with (
        open_port(yarpy.Port, "/opening/a") as a,
        open_port(yarpy.Port, "/opening/b") as b,
        open_port(yarpy.Port, "/opening/c") as c,
    ):
        send_to(a, "/opening/b")
        hear_from(a, "fast_tcp://opening/c")
        assert [(link.name, link.carrier) for link in a.outputs] == [("/opening/b", "tcp")]
        assert [(link.name, link.carrier) for link in c.outputs] == [("/opening/a", "fast_tcp")]
        assert b.wait_for_inputs(timeout=HANG)


def test_topics(server):
    with open_port(yarpy.Port, "/opening/d") as d, open_port(yarpy.Port, "/opening/e") as e:
        send_to(d, "topic://opening/t")
        hear_from(e, "topic://opening/t")
        assert e.wait_for_inputs(timeout=HANG)
        assert d.wait_for_outputs(timeout=HANG)
        assert [link.name for link in d.outputs] == ["/opening/e"]


def test_a_living_name_is_not_taken():
    with (
        open_port(yarpy.Port, "/opening/f"),
        pytest.raises(yarpy.AddressError, match="in use"),
    ):
        open_port(yarpy.Port, "/opening/f")


def test_programs_of_one_kind_run_side_by_side():
    with (
        open_another(yarpy.Port, "/opening/page") as first,
        open_another(yarpy.Port, "/opening/page") as second,
    ):
        assert (first.name, second.name) == ("/opening/page", "/opening/page/2")


def test_a_page_needs_no_name(monkeypatch):
    monkeypatch.delenv("YARPY_SERVER")
    with open_another(yarpy.Port, "/opening/page") as port:
        assert port.name == "/" + port.address.replace(":", "_")


def test_without_a_name_server(monkeypatch, capsys):
    """Ports without a name talk by address."""
    monkeypatch.delenv("YARPY_SERVER")
    with pytest.raises(yarpy.NoNameServer):
        open_port(yarpy.Port, "/opening/g")
    with open_port(yarpy.Port, "...") as reader, open_port(yarpy.Port, "...") as writer:
        assert f"others reach it at /{reader.address}" in capsys.readouterr().err
        send_to(writer, f"/{reader.address}")
        writer.write(["by address"])
        assert reader.read(timeout=HANG).value == ["by address"]
        writer.outputs[0].close()
        hear_from(reader, f"tcp://{writer.address}/")
        writer.wait_for_outputs(timeout=HANG)
        writer.write(["again"])
        assert reader.read(timeout=HANG).value == ["again"]


def test_ports_close_with_the_command(names):
    with click.Context(click.Command("other")):
        port = open_port(yarpy.Port, "/opening/h")
        assert names.query("/opening/h") is not None
    assert port.closed
    assert names.query("/opening/h") is None


def test_a_signal_while_a_port_opens(names, monkeypatch):
    """It is heard when the port is open, and closes it."""
    known = [number for number in signal.Signals if number.name in signals._NAMES]
    before = [signal.getsignal(number) for number in known]
    signals.watch()

    def slow(name, **options):
        signal.raise_signal(signal.SIGTERM)
        time.sleep(0.01)
        return yarpy.Port(name, **options)

    try:
        with pytest.raises(signals.Interrupted), click.Context(click.Command("other")):
            open_port(slow, "/opening/i")
    finally:
        for number, handler in zip(known, before, strict=True):
            signal.signal(number, handler)
    assert names.query("/opening/i") is None


def test_a_name_that_is_empty(names):
    """As of a variable that is not set: such a port would wait for ever, found by nobody."""
    with (
        click.Context(click.Command("x")),
        pytest.raises(yarpy.AddressError, match=r"is empty .* `\.\.\.` stands for any free one"),
    ):
        open_port(yarpy.Port, "")


def test_a_type_that_nobody_has_is_said(names, capsys):
    with click.Context(click.Command("x")):
        open_port(yarpy.Port, "/typed", port_type="std_srvs/SetBol")
        open_port(yarpy.Port, "/other", port_type="yarp::os::Bottle")
    said = capsys.readouterr().err
    assert said.count("warning:") == 1 and "SetBol" in said
