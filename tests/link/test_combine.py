"""Which carriers go over which transports: every pair that is refused says what to do instead."""

from __future__ import annotations

import pytest

from yarpy import registry
from yarpy.link.combine import combine
from yarpy.shipped import CARRIERS

REFUSED = [
    ("udp", "tls", "TLS protects no datagrams: take tls, not udp"),
    ("mcast", "tls", "TLS protects no datagrams: take tls, not mcast"),
    ("mpi", "tls", "TLS protects nothing that mpi sends: take tls"),
    ("bcast", "tls", "TLS protects nothing that bcast sends: take tls"),
    *(
        (name, "zenoh", f"{name} does not go through Zenoh: take tcp")
        for name in ("udp", "mcast", "unix_stream", "local", "memory", "shmem", "mpi", "bcast")
    ),
]


def answer(carrier: str, base: str, secure: bool) -> str:
    row = registry.transports.facts(base)
    return combine(carrier, CARRIERS[carrier].over, row, secure)


@pytest.mark.parametrize(("carrier", "base", "reason"), REFUSED)
def test_what_is_refused_says_why(carrier: str, base: str, reason: str) -> None:
    assert answer(carrier, base, base == "tls") == reason


@pytest.mark.parametrize("base", ["tcp", "tls", "zenoh"])
def test_everything_else_goes(base: str) -> None:
    refused = {(name, where) for name, where, _ in REFUSED}
    ours = [name for name, row in CARRIERS.items() if not row.reaches.topic]
    found = {(name, base) for name in ours if answer(name, base, base == "tls")}
    assert found == {pair for pair in refused if pair[1] == base}


def test_topics_go_over_their_own_transport_alone() -> None:
    for name in ("ros2", "zenoh"):
        assert answer(name, name, True) == ""


def test_no_tls_where_routers_pass_messages_on() -> None:
    assert "no TLS through them" in answer("tcp", "zenoh", True)
