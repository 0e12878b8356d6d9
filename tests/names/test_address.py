"""Which address of this computer others are told."""

import socket

import pytest

from yarpy.names import address
from yarpy.names.address import (
    address_towards,
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


def test_a_system_without_interfaces_to_read(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> object:
        raise OSError("no getifaddrs")

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


def test_the_local_end_of_the_connection_is_what_the_other_side_reaches() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        socket.create_connection(listener.getsockname()) as connection,
    ):
        assert address_towards(connection, {}) == "127.0.0.1"
        assert address_towards(connection, {"YARP_IP": "10."}, SOME) == "10.0.0.12"
        assert address_towards(connection, {"YARP_IP": "172."}, SOME) == "127.0.0.1"


def test_an_ipv4_peer_of_an_ipv6_socket() -> None:
    try:
        listener = socket.create_server(
            ("", 0), family=socket.AF_INET6, dualstack_ipv6=socket.has_dualstack_ipv6()
        )
    except OSError:
        pytest.skip("no IPv6 here")
    with (
        listener,
        socket.create_connection(("127.0.0.1", listener.getsockname()[1])) as connection,
        listener.accept()[0] as accepted,
    ):
        assert address_towards(accepted, {}) == "127.0.0.1"
        assert address_towards(connection, {}) == "127.0.0.1"


def test_without_a_connection_the_best_guess() -> None:
    assert address_towards(None, {}, SOME) == "10.0.0.12"
    assert outward_address(SOME) == "10.0.0.12", "not loopback, and the shorter text"
    assert outward_address(["::1", "127.0.0.1"]) == "127.0.0.1"
    assert outward_address(["::1", "fe80::1"]) == "127.0.0.1"
    assert outward_address() in local_addresses()
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as unbound:
        assert address_towards(unbound, {}, SOME) == "10.0.0.12"
    one, other = socket.socketpair()
    with one, other:
        assert address_towards(one, {}, SOME) == "10.0.0.12"
