"""Who dials a port: with its key or without, strangers, and those who come too early."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.carriers.base import Carrier
from yarpy.link.driver import Driver
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.port.answer import reception
from yarpy.port.answer.reception import Reception
from yarpy.port.keep.registration import Registration
from yarpy.port.port import Port
from yarpy.wire import framing


def test_who_comes_before_the_port_knows_its_name_waits() -> None:
    served: list[str] = []

    def serve(driver: Driver, carrier: Carrier) -> None:
        served.append(carrier.route.source)
        driver.transport.close()

    registration = Registration("/here", None, "", register=False)
    reception = Reception(registration, 1000, serve)
    registration.port = reception.listen(0)
    try:
        with socket.create_connection(("127.0.0.1", registration.port)) as sock:
            sock.sendall(b"CONNECT /early\r\n")
            sock.settimeout(0.2)
            with pytest.raises(TimeoutError):
                sock.recv(100)
            assert served == []
            reception.open()
            sock.settimeout(10)
            assert sock.recv(100) == b"Welcome /early\r\n"
            wait_until(lambda: served == ["/early"])
    finally:
        reception.close()
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", registration.port))


def test_closing_lets_nobody_wait_for_a_name_that_never_comes() -> None:
    registration = Registration("/here", None, "", register=False)
    reception = Reception(registration, 1000, lambda driver, carrier: None)
    registration.port = reception.listen(0)
    with socket.create_connection(("127.0.0.1", registration.port)) as sock:
        sock.sendall(b"CONNECT /early\r\n")
        wait_until(lambda: any(t.name == "yarpy /here <- ?" for t in threading.enumerate()))
        reception.close()
        wait_until(lambda: not any(t.name == "yarpy /here <- ?" for t in threading.enumerate()))


@pytest.mark.parametrize("where", ["greeting", "serving"])
def test_a_defect_ends_one_connection_with_one_line(
    where: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Its thread ends in good order, and the socket is closed."""
    uncaught: list[object] = []
    monkeypatch.setattr(threading, "excepthook", uncaught.append)

    def fail(*_: object, **__: object) -> None:
        raise MemoryError("no room")

    if where == "greeting":
        monkeypatch.setattr(reception, "welcome", fail)
    registration = Registration("/here", None, "", register=False)
    there = Reception(registration, 1000, fail)
    registration.port = there.listen(0)
    try:
        there.open()
        with socket.create_connection(("127.0.0.1", registration.port)) as sock:
            sock.sendall(b"CONNECT /early\r\n")
            sock.settimeout(20)
            with contextlib.suppress(ConnectionResetError):
                while sock.recv(100):
                    pass
        wait_until(lambda: "MemoryError: no room" in caplog.text)
    finally:
        there.close()
    assert len(caplog.records) == 1 and not caplog.records[0].exc_info
    assert not uncaught


def test_closing_does_not_wait_for_strangers(names: LocalNames) -> None:
    port = Port("/here", names=names)
    with socket.create_connection(("127.0.0.1", port.contact.port)) as sock:
        sock.sendall(b"CONNECT /nobody\r\n")
        assert sock.recv(100) == b"Welcome /nobody\r\n"
        started = time.monotonic()
        port.close()
        assert lasted(started) < 3


def test_garbage_first_then_a_good_connection(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with Port("/in", names=names) as in_:
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"what is this?\r\n")
            with sock.makefile("rb") as lines:
                assert lines.readline() == b"* Error. Protocol not found.\r\n"
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"CONNECT test\r\nd\r\nhello 1\r\n")
            assert in_.read(timeout=HANG).value == ["hello", 1]
        wait_until(lambda: "refused" in caplog.text)
    (line,) = [r for r in caplog.records if r.levelno >= logging.WARNING]
    assert "refused" in line.getMessage()
    assert "127.0.0.1:" in line.getMessage()


def test_unknown_carrier_code(names: LocalNames) -> None:
    with (
        Port("/in", names=names) as in_,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as sock,
    ):
        sock.settimeout(5)
        sock.sendall(framing.number(framing.BASE + 5))
        assert sock.recv(28) == b"* Error. Protocol not found."
        assert in_.inputs == []


# ---------------------------------------------------------------------------------- keys


@pytest.fixture
def key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A configuration directory with a key in it."""
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    (tmp_path / "auth.conf").write_text("[AUTH]\nkey secret word\n")
    return tmp_path


def test_ports_and_tools_with_the_same_key_find_each_other(key: Path) -> None:
    with NameServer(), Port("/in") as in_, Port("/out") as out:
        out.connect("/in")
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
        assert network.exists("/in")
        assert network.is_connected("/out", "/in")
        assert network.ping("/in")[0].startswith("This is /in at ")
        assert network.disconnect("/out", "/in")


def test_who_does_not_know_the_key_stays_out(
    key: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    other = tmp_path / "other"
    other.mkdir()
    code = """
import sys, yarpy
names = yarpy.LocalNames()
with yarpy.Port("", names=names) as port:
    try:
        port.connect(sys.argv[1])
    except yarpy.YarpError as error:
        print(type(error).__name__, error)
"""
    names = LocalNames()
    with Port("/in", names=names) as in_:
        for word in ("[AUTH]\nkey another\n", None):
            if word:
                (other / "auth.conf").write_text(word)
            else:
                (other / "auth.conf").unlink()
            done = subprocess.run(
                [sys.executable, "-c", code, f"/127.0.0.1:{in_.contact.port}"],
                capture_output=True,
                text=True,
                timeout=20,
                env={**os.environ, "YARP_CONFIG_HOME": str(other)},
            )
            assert "auth.conf" in done.stdout, done.stdout + done.stderr
        wait_until(lambda: "refused" in caplog.text)
        assert in_.inputs == []


def test_person_cannot_get_in_either(key: Path) -> None:
    with (
        Port("/in", names=LocalNames()) as in_,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as sock,
    ):
        sock.settimeout(5)
        sock.sendall(b"CONNECT me and some more words to fill the forty bytes\r\n")
        assert len(sock.recv(40)) == 40  # the port speaks first
        assert sock.recv(40) == b""


def test_who_looks_whether_a_port_with_a_key_listens_is_told_of_once(
    key: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """As name servers of other computers do, every few seconds."""
    with Port("/looked/at", names=LocalNames()) as port:
        for _ in range(3):
            with socket.create_connection(("127.0.0.1", port.contact.port)) as sock:
                sock.settimeout(20)
                assert sock.recv(1)  # its part of the proof
            wait_until(lambda: "yarpy /looked/at <- ?" not in _names())
    told = [one for one in caplog.messages if "/looked/at: connection from" in one]
    assert len(told) == 1 and "instead of proving that it knows our key" in told[0]


def _names() -> list[str]:
    """Return what the threads of this process are called."""
    return [one.name for one in threading.enumerate()]
