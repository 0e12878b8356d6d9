"""One port, or the name server, asked by a program that has no port."""

from __future__ import annotations

import logging

import pytest
from support.guest import guest
from support.port import free_port
from support.wait import wait_until

import yarpy
from yarpy import network
from yarpy.contact import Contact
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    NoNameServer,
    UnknownName,
    WrongPort,
)
from yarpy.nameserver.local import LocalNames
from yarpy.network.asking import called
from yarpy.port.port import Port


def test_where_a_port_is(names: LocalNames) -> None:
    with Port("/in", names=names) as port:
        assert network.query("/in", names) == port.contact
        assert network.query("/none", names) is None
        assert network.query("/127.0.0.1:5", names) == Contact("tcp", "", "127.0.0.1", 5)
        assert network.find("/in", names) == port.contact
        with pytest.raises(UnknownName, match='did you mean "/in"'):
            network.find("/inn", names)


def test_description_of_a_port(names: LocalNames) -> None:
    with Port("/in", names=names) as port:
        assert network.ping("/in", names=names) == [
            f"This is /in at tcp://{port.address}/",
            "There are no outgoing connections",
            "There is an input connection from <ping> to /in using text_ack",
        ]
    with pytest.raises(UnknownName):
        network.ping("/in", names=names)


def test_administration_from_outside(names: LocalNames) -> None:
    with Port("/in", names=names):
        assert network.admin("/in", "ver", names=names)[1:] == [1, 2, 3]
        assert network.admin("/in", "prop", "set", "color", "red", names=names) == ["ok"]
        assert network.admin("/in", "prop", "get", "color", names=names) == ["red"]
    names.register("/dead", "tcp", "127.0.0.1", free_port())
    with pytest.raises(LinkClosed, match=r"yarpy clean"):
        network.admin("/dead", "ver", names=names)


def test_nothing_is_changed_at_another_port(names: LocalNames) -> None:
    """One that has the number by now which the name service remembers of a port that is gone."""
    with Port("/motor", names=names) as motor, Port("/viewer", names=names):
        motor.connect("/viewer")
        names.register("/camera", "tcp", "127.0.0.1", motor.contact.port)
        assert network.admin("/camera", "ver", names=names)  # by hand: an alias
        names.set("/camera", "process", 1)  # as ports say of themselves
        with pytest.raises(WrongPort, match=r'"/motor" listens .*, not "/camera"'):
            network.admin("/camera", "prop", "set", "color", "red", names=names)
        assert not network.exists("/camera", names=names)
        with pytest.raises(WrongPort, match='not "/camera"'):
            network.disconnect("/camera", "/viewer", names=names)
        assert motor.outputs
        assert not network.admin("/motor", "prop", "get", "color", names=names)


def test_nobody_to_ask(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{free_port()}")
    for ask in (network.query, network.exists, network.ping):
        with pytest.raises(NoNameServer):
            ask("/in")


def test_questions_leave_no_trace(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    """Tools are no connections that anybody wants to hear of."""
    caplog.set_level(logging.INFO, "yarpy")
    with Port("/in", names=names) as port:
        caplog.clear()
        network.exists("/in", names=names)
        network.ping("/in", names=names)
        network.admin("/in", "ver", names=names)
        wait_until(lambda: not port._hub.inputs.links)
        assert caplog.records == []


def test_connection_to_an_address_is_known_by_the_name_that_is_there(names: LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as in_:
        address = f"/{in_.address}/"
        yarpy.connect("/out", address, names=names)
        wait_until(lambda: in_.inputs)
        assert called("/out", "/in", names) == address
        assert called("/in", "/out", names) == "/out"
        assert called("/out", "/other", names) == "/other"
        assert yarpy.is_connected("/out", "/in", names=names)
        assert yarpy.disconnect("/out", "/in", names=names)
        assert not out.outputs


def test_who_has_no_server_is_told_of_one() -> None:
    guest("ros", "zenoh")
    from yarpy.peers.ros.names import RosNames

    for names, told in (
        (yarpy.LocalNames(), "`yarpy server` starts one"),
        (yarpy.zenoh.ZenohNames("tcp/127.0.0.1:1"), "`yarpy server --zenoh`"),
        (RosNames(None), "/TOPIC@/NODE"),  # type: ignore[arg-type]
    ):
        with pytest.raises(LocalProtocolError, match=told):
            network.ask_server(names, ["topic", "list"])
