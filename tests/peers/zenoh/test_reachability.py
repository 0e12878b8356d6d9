"""Whether a port of another computer can be dialled."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from dataclasses import replace

import pytest

import yarpy
from yarpy.contact import Contact
from yarpy.peers.zenoh import reachability as direct
from yarpy.peers.zenoh.key import Entry
from yarpy.peers.zenoh.reachability import Reachability, candidates, machine, reachable

FAR = Entry(Contact("tcp", "/far", "127.0.0.1", 1), "ab", 1, "0123", 1, ("198.51.100.7",))


@pytest.fixture
def port() -> Iterator[yarpy.BufferedPort]:
    with yarpy.BufferedPort("/far", names=yarpy.LocalNames()) as opened:
        yield opened


def test_this_computer_is_one() -> None:
    assert machine() == machine() and int(machine(), 16)


def test_the_port_that_answers_is_the_one(port: yarpy.BufferedPort) -> None:
    number = port.contact.port
    assert reachable(["127.0.0.1"], number, "/far") == "127.0.0.1"
    assert reachable(["127.0.0.1"], number, "/other") == ""
    assert reachable(["no host", "127.0.0.1"], number, "/far") == "127.0.0.1"
    assert reachable([], number, "/far") == ""


def test_nobody_answers() -> None:
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        assert reachable(["127.0.0.1"], sock.getsockname()[1], "/far") == ""


@pytest.mark.parametrize("said", [b"", b"Welcome admin\r\n", b"\xff\n" * 5000, b"no\nidea\n"])
def test_what_answers_is_no_port(said: bytes) -> None:
    """It may be one with a key, or with rules; it is asked again when it is dialled."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            sock, _ = server.accept()
            with sock:
                sock.recv(100)
                sock.sendall(said)

        thread = threading.Thread(target=answer)
        thread.start()
        assert reachable(["127.0.0.1"], server.getsockname()[1], "/far") == "127.0.0.1"
        thread.join()


def test_silence_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(direct, "TIMEOUT", 0.02)
    with socket.create_server(("127.0.0.1", 0)) as server:
        assert reachable(["127.0.0.1"], server.getsockname()[1], "/far") == ""


def test_own_and_local_addresses_lead_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(direct, "local_addresses", lambda: ["172.17.0.1", "127.0.0.1"])
    entry = replace(FAR, addresses=("172.17.0.1", "fe80::1", "::1", "198.51.100.7"))
    assert candidates(entry) == ["198.51.100.7"]


def test_this_computer_s_ports_are_where_they_say() -> None:
    entry = replace(FAR, machine=machine())
    assert Reachability().to(entry) == entry.contact


def test_what_was_found_is_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def look(hosts: list[str], port: int, name: str) -> str:
        asked.append(name)
        return hosts[0]

    monkeypatch.setattr(direct, "reachable", look)
    found = Reachability()
    assert found.to(FAR).host == found.to(FAR).host == "198.51.100.7"
    assert asked == ["/far"]
    assert found.to(replace(FAR, zid="cd")).host == "198.51.100.7" and len(asked) == 2


def test_what_is_no_port_of_yarp_is_not_dialled() -> None:
    camera = replace(FAR, contact=Contact("mjpeg", "/webcam", "198.51.100.9", 80))
    assert Reachability().to(camera) == camera.contact
