"""Two ports as the ends of a connection that a third program makes or ends."""

from __future__ import annotations

import pytest
from support.port import free_port

import yarpy
from yarpy import network
from yarpy.contact import Contact
from yarpy.errors import (
    LocalProtocolError,
    NotAllowed,
    UnknownPlugin,
    WrongPort,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.answer import admin
from yarpy.port.connect import identity
from yarpy.port.port import Port
from yarpy.transports import tcp


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


def test_a_connection_takes_three_of_tcp(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One to the port in charge, from which two lead on: a look at who listens, and its own."""
    dialled: list[int] = []
    dial = tcp.dial

    def counting(host: str, port: int, timeout: float) -> tcp.TcpTransport:
        dialled.append(port)
        return dial(host, port, timeout)

    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        monkeypatch.setattr(tcp, "dial", counting)
        network.connect("/out", "/in", names=names)
        assert dialled == [out.contact.port, in_.contact.port, in_.contact.port]


@pytest.mark.parametrize("carrier", ["", "udp", "mjpeg"])
def test_nobody_is_connected_with_another_port(carrier: str, names: LocalNames) -> None:
    """The one that listens at the number of a port that is gone, whoever is to dial it."""
    with Port("/arm", names=names) as arm, Port("/motor", names=names) as motor:
        names.register("/camera", "tcp", "127.0.0.1", motor.contact.port)
        names.set("/camera", "process", 1)  # as ports say, and nobody by hand
        for ends in (("/arm", "/camera"), ("/camera", "/arm")):
            with pytest.raises(WrongPort, match=r'"/motor" listens .*, not "/camera"'):
                network.connect(*ends, carrier, names=names)
        assert not (arm.inputs or arm.outputs or motor.inputs or motor.outputs)


def test_who_cannot_look_itself_does_not_have_to(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A port of C++ YARP in charge dials whatever has the number: we look for it."""
    looked: list[str] = []
    introduce = identity.probe.introduce

    def noting(contact: Contact, *more: object) -> object:
        looked.append(contact.name)
        return introduce(contact, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(identity.probe, "introduce", noting)
    monkeypatch.delitem(admin._HANDLERS, "stat")  # as there
    with Port("/out", names=names), Port("/in", names=names):
        network.connect("/out", "/in", names=names)
        assert looked == ["/in", "/in"]
