"""Which address of this computer others are told."""

import socket

import pytest

from yarpy.names import address
from yarpy.names.address import (
    is_local,
    is_loopback,
    local_addresses,
    outward_address,
    plain_host,
)

SOME = ["127.0.0.1", "10.0.0.12", "192.168.100.100", "::1", "fe80::1"]


def test_local_addresses_are_ours() -> None:
    found = local_addresses()
    assert "127.0.0.1" in found
    assert len(found) == len(set(found))
    for host in found:
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        assert socket.inet_ntop(family, socket.inet_pton(family, host)) == host
        if not host.startswith("fe80"):  # those need a zone to be bound
            with socket.socket(family, socket.SOCK_DGRAM) as probe:
                probe.bind((host, 0))


# TypeError: the C library of Windows has no name, and None is none there.
@pytest.mark.parametrize("error", [OSError, AttributeError, TypeError])
def test_a_system_without_interfaces_to_read(
    error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> object:
        raise error("no getifaddrs")

    monkeypatch.setattr(address, "_interface_addresses", broken)
    assert local_addresses()[0] == "127.0.0.1"
    monkeypatch.setattr(address, "_addresses_of_own_name", lambda: iter(["10.0.0.5", "127.0.0.1"]))
    assert local_addresses() == ["127.0.0.1", "10.0.0.5"]


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("10.0.0.1", "10.0.0.1"),
        ("::ffff:10.0.0.1", "10.0.0.1"),
        ("::FFFF:10.0.0.1", "10.0.0.1"),
        ("::ffff:0:1", "::ffff:0:1"),
        ("fe80::1%eth0", "fe80::1"),
        ("[::1]", "::1"),
        ("host.example", "host.example"),
        ("", ""),
    ],
)
def test_plain_host(text: str, plain: str) -> None:
    assert plain_host(text) == plain


def test_loopback() -> None:
    for host in ("127.0.0.1", "127.9.9.9", "::1", "localhost", "::ffff:127.0.0.1"):
        assert is_loopback(host)
        assert is_local(host)
    for host in ("10.0.0.1", "fe80::1", "example.org", ""):
        assert not is_loopback(host)


def test_is_local() -> None:
    for host in local_addresses():
        assert is_local(host)
    assert not is_local("192.0.2.77")
    assert not is_local("no.such.host.invalid")
    assert not is_local("x" * 300)


def test_the_best_guess() -> None:
    assert outward_address(SOME) == "10.0.0.12", "not loopback, and the shorter text"
    assert outward_address(["::1", "127.0.0.1"]) == "127.0.0.1"
    assert outward_address(["::1", "fe80::1"]) == "127.0.0.1"
    assert outward_address() in local_addresses()
