"""Two ports as the ends of a connection that a third program makes or ends."""

from __future__ import annotations

import pytest
from support.port import free_port

import yarpy
from yarpy import network
from yarpy.errors import (
    LocalProtocolError,
    NotAllowed,
    UnknownPlugin,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port


def test_local_is_not_asked_of_two_programs(names: LocalNames) -> None:
    """A port of C++ YARP that is dialled so from another program crashes."""
    with Port("/out", names=names) as out, Port("/in", callback=lambda message: None, names=names):
        for name in ("/out", "/in"):
            names.set(name, "process", 1)
        network.connect("/out", "/in", "local", names=names)
        assert network.disconnect("/out", "/in", names=names)
        names.set("/in", "process", 2)
        with pytest.raises(NotAllowed, match="two programs"):
            network.connect("/out", "/in", "local", names=names)
        assert not out.outputs


def test_carriers_of_others_that_the_receiver_dials(names: LocalNames) -> None:
    with (
        Port("/out", names=names),
        Port("/in", names=names),
        pytest.raises(UnknownPlugin, match="refused: Cannot connect to h264://out: no"),
    ):
        network.connect("/out", "/in", "h264", names=names)


def test_endpoint_that_takes_no_commands_constrains_the_carrier(names: LocalNames) -> None:
    """A camera's web server, registered by hand, has a carrier of its own; nobody asks it."""
    names.register("/cam", "mjpeg", "127.0.0.1", free_port())
    with Port("/viewer", names=names):
        with pytest.raises(LocalProtocolError, match="conflict between tcp and mjpeg"):
            network.connect("/cam", "/viewer", "tcp", names=names)
        with pytest.raises((LocalProtocolError, UnknownPlugin)):
            network.connect("/viewer", "/cam", names=names)


def test_connection_to_an_address_with_a_name_can_be_ended_by_it(names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names) as in_:
        target = f"tcp://{in_.address}/in"
        yarpy.connect("/out", target, names=names)
        assert [link.target for link in out.outputs] == ["/in"]
        assert yarpy.is_connected("/out", target, names=names)
        assert yarpy.disconnect("/out", target, names=names)
        assert not out.outputs
