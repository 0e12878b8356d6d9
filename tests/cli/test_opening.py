"""Ports that commands open."""

import pytest

import yarpy
from yarpy.cli.opening import hear_from, open_port, send_to


@pytest.fixture(autouse=True)
def quiet(here):
    """The log as it was, and the environment of this file's server."""


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
        assert b.wait_for_inputs(timeout=5)


def test_topics(server):
    with open_port(yarpy.Port, "/opening/d") as d, open_port(yarpy.Port, "/opening/e") as e:
        send_to(d, "topic://opening/t")
        hear_from(e, "topic://opening/t")
        assert e.wait_for_inputs(timeout=5)
        assert [link.name for link in d.outputs] == ["/opening/e"]


def test_a_living_name_is_not_taken():
    with (
        open_port(yarpy.Port, "/opening/f"),
        pytest.raises(yarpy.AddressError, match="in use"),
    ):
        open_port(yarpy.Port, "/opening/f")


def test_without_a_name_server(monkeypatch, capsys):
    """Ports without a name talk by address."""
    monkeypatch.delenv("YARPY_SERVER")
    with pytest.raises(yarpy.NoNameServer):
        open_port(yarpy.Port, "/opening/g")
    with open_port(yarpy.Port, "...") as reader, open_port(yarpy.Port, "...") as writer:
        assert f"others reach it at /{reader.address}" in capsys.readouterr().err
        send_to(writer, f"/{reader.address}")
        writer.write(["by address"])
        assert reader.read(timeout=5).value == ["by address"]
        writer.outputs[0].close()
        hear_from(reader, f"tcp://{writer.address}/")
        writer.wait_for_outputs(timeout=5)
        writer.write(["again"])
        assert reader.read(timeout=5).value == ["again"]
