"""Where ports listen: the setting, the sockets, what a port registers, and other addresses."""

from __future__ import annotations

import logging
import socket

import pytest
from support.system import NO_UNIX_SOCKETS
from support.wait import HANG

import yarpy
from yarpy.names.address import is_loopback, local_addresses
from yarpy.transports.bind import listening_host, reach

OUTWARD = [one for one in local_addresses() if "." in one and not is_loopback(one)]


@pytest.mark.parametrize(
    ("said", "host", "told"),
    [
        ("", "", "all networks"),
        ("all", "", "all networks"),
        ("local", "127.0.0.1", "this computer alone"),
        ("127.0.0.2", "127.0.0.2", "this computer alone"),
        ("192.168.1.7", "192.168.1.7", "the network of 192.168.1.7 alone"),
    ],
)
def test_setting(monkeypatch: pytest.MonkeyPatch, said: str, host: str, told: str) -> None:
    monkeypatch.setenv("YARPY_BIND", said)
    assert listening_host() == host
    assert told in reach()


def reached(host: str, port: int) -> bool:
    try:
        socket.create_connection((host, port), 2.0).close()
    except OSError:
        return False
    return True


@pytest.mark.skipif(not OUTWARD, reason="this computer has no address but the loopback")
@pytest.mark.parametrize("setting", ["local", ""])
def test_others_reach_what_they_should(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, setting: str
) -> None:
    caplog.set_level(logging.INFO)
    monkeypatch.setenv("YARPY_BIND", setting)
    host = "127.0.0.1" if setting else OUTWARD[0]
    with yarpy.NameServer(host=host) as server, yarpy.Port("/in") as in_, yarpy.Port("/out") as out:
        for port in (server.port, in_.contact.port):
            assert reached("127.0.0.1", port)
            assert reached(OUTWARD[0], port) == (not setting)
        assert is_loopback(in_.contact.host) == bool(setting)
        for carrier in ("tcp", "udp") if NO_UNIX_SOCKETS else ("tcp", "udp", "unix_stream"):
            out.connect("/in", carrier)
            out.write([carrier])
            message = in_.read(timeout=HANG)
            assert message is not None
            assert message.value == [carrier]
    told = "open to this computer alone" if setting else "open to all networks"
    assert caplog.text.count(told) >= 3


@pytest.mark.skipif(not OUTWARD, reason="this computer has no address but the loopback")
def test_port_of_the_loopback_does_not_register_an_address_that_leads_nowhere(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with yarpy.NameServer(host=OUTWARD[0]):
        monkeypatch.setenv("YARPY_BIND", "local")
        with yarpy.Port("/in") as in_, yarpy.Port("/out") as out:
            assert in_.contact.host == "127.0.0.1"
            out.connect("/in")


def test_address_that_is_not_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_BIND", "192.0.2.1")
    with pytest.raises(yarpy.AddressError, match=r"YARPY_BIND=192\.0\.2\.1"):
        yarpy.Port("/in", names=yarpy.LocalNames())
