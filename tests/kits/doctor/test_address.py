"""Findings about addresses; test_examination.py has the faults."""

import socket

import pytest
from support.doctor import answering, made_up

from yarpy.config.configuration import Server
from yarpy.contact import Contact
from yarpy.kits.doctor import address
from yarpy.kits.doctor.address import find
from yarpy.network.traffic import PortState


def test_another_address_of_the_port_is_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """127.0.0.1 plays an address of another network."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        number = server.getsockname()[1]
        away = PortState("/a", Contact("tcp", "/a", "192.0.2.1", number), "unreachable", "no route")
        case = made_up(ports=(away,), wanted=("/a",))
        case.property_of = lambda name, key: ["192.0.2.1", "127.0.0.1"]  # type: ignore[method-assign]
        monkeypatch.setattr(address, "is_loopback", lambda host: False)
        [finding] = find(case)
        assert "YARP_IP=127.0.0.1" in finding.advice


def test_a_loopback_address_known_to_a_server_elsewhere() -> None:
    here = answering("/a", contact=Contact("tcp", "/a", "127.0.0.1", 10002))
    case = made_up(ports=(here,), wanted=("/a",), servers=(Server("192.0.2.9", 10000),))
    [finding] = find(case)
    assert (finding.probe, "leads to this one" in finding.verdict) == ("unreachable", True)


def test_nonsense_as_an_address() -> None:
    away = PortState("/a", Contact("tcp", "/a", "192.0.2.1", 99999), "unreachable")
    case = made_up(ports=(away,), wanted=("/a",))
    case.property_of = lambda name, key: ["\ud800", "", "x" * 300]  # type: ignore[method-assign]
    [finding] = find(case)
    assert "ping 192.0.2.1" in finding.advice
