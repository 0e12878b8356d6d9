"""A port to hear from: not there yet, gone and back, disconnected on purpose."""

from __future__ import annotations

import threading
import time

import click
import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli import source
from yarpy.cli.source import Source


@pytest.fixture
def default(server, monkeypatch):
    """The server of these tests is the one that a command uses."""
    for name, value in server.environment.items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def listener(default):
    with yarpy.BufferedPort("/source/in") as port:
        yield port


def follow(port, name, **options):
    """A Source, and the lines that it told."""
    lines = []
    return Source(port, name, tell=lines.append, **options), lines


def test_it_is_connected_at_once(listener):
    with yarpy.Port("/source/out") as out:
        found, lines = follow(listener, "/source/out")
        assert lines == [""]
        wait_until(lambda: found.connected)  # the sender knows a moment before
        assert out.outputs[0].carrier == "tcp"
        assert follow(listener, "udp://source/out")[0].connected  # it is; nothing is done


def test_carrier(listener):
    with yarpy.Port("/source/out") as out:
        follow(listener, "/source/out", carrier="fast_tcp")
        assert out.outputs[0].carrier == "fast_tcp"


def test_it_is_waited_for_and_comes_back_however_late(listener, monkeypatch):
    monkeypatch.setattr(
        "yarpy.port.connect.reconnect.INPUT_TIMEOUT", 0.0
    )  # the port itself gives up
    found, lines = follow(listener, "/source/late")
    assert not found.connected
    assert lines[0].startswith('Waiting for /source/late: no port "/source/late"')
    for number in range(2):
        with yarpy.Port("/source/late") as out:
            wait_until(lambda: found.connected)
            wait_until(lambda: lines[-1] == "" and out.outputs)
            out.write([number])
            assert listener.read(timeout=HANG).value == [number]
            wait_until(lambda: not found._wanted)  # it knows that it is connected
        wait_until(lambda: not found.connected)
        wait_until(lambda: found._wanted)  # it has been seen to be gone


def test_who_disconnects_them_means_it(listener):
    with yarpy.Port("/source/out"):
        found, _ = follow(listener, "/source/out")
        time.sleep(2 * source.PAUSE)
        assert yarpy.disconnect("/source/out", "/source/in")
        wait_until(lambda: not found.connected)
        time.sleep(4 * source.PAUSE)
        assert not found.connected


@pytest.mark.parametrize(
    ("name", "carrier", "error"),
    [
        ("/source/out", "nonsense", yarpy.UnknownPlugin),
        ("noslash", None, yarpy.AddressError),
        ("/with blank", None, yarpy.AddressError),
    ],
)
def test_what_is_wrong_in_itself(listener, name, carrier, error):
    with pytest.raises(error):
        Source(listener, name, carrier)


def test_it_ends_with_the_port(default):
    with yarpy.BufferedPort("/source/short") as port, click.Context(click.Command("x")):
        Source(port, "/source/nobody")
        assert "yarpy source /source/nobody" in names_of_threads()
    wait_until(lambda: "yarpy source /source/nobody" not in names_of_threads())


def names_of_threads():
    return {thread.name for thread in threading.enumerate()}
