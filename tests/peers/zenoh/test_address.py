"""Addresses inside Zenoh."""

from __future__ import annotations

from yarpy import registry
from yarpy.peers.zenoh.address import ZENOH, host_zid, zid_host


def test_a_session_is_a_host() -> None:
    assert host_zid(zid_host("a1b2")) == "a1b2"
    assert host_zid("10.0.0.1") == host_zid("localhost") == ""


def test_the_core_knows_the_ending_as_a_fact() -> None:
    assert registry.transports.of_host(zid_host("a1b2")).name == "zenoh"
    assert registry.transports.facts("zenoh").hosts == ZENOH
