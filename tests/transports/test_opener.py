"""Openers: their facts are those of the rows, and what they cannot do says so."""

from __future__ import annotations

import pytest
from support.guest import is_here

from yarpy import registry
from yarpy.contact import Contact
from yarpy.errors import LocalProtocolError
from yarpy.facts import TransportRow
from yarpy.shipped import TRANSPORTS
from yarpy.transports.base import Transport
from yarpy.transports.opener import MeetingPlace, Opener

HERE = {name: row for name, row in TRANSPORTS.items() if is_here(row)}


@pytest.mark.parametrize("row", HERE.values(), ids=HERE)
def test_a_row_says_what_its_opener_says(row: TransportRow) -> None:
    opener = registry.transports.load(row.name)
    assert issubclass(opener, Opener) and opener.name == row.name
    said = TransportRow.of(row.name, opener)
    facts = TransportRow.__dataclass_fields__.keys() - {"extra"}
    assert {key: getattr(said, key) for key in facts} == {key: getattr(row, key) for key in facts}


def test_what_an_opener_cannot_do() -> None:
    class Own(Opener):
        name = "own"

    with pytest.raises(LocalProtocolError, match="nothing can be dialled over own"):
        Own.dial(Contact("tcp", "/x", "127.0.0.1", 1), 1.0)
    with pytest.raises(LocalProtocolError, match="cannot meet over own"):
        Own.meet(MeetingPlace(Transport(), False, 0, "", 1.0))


def test_hosts_lead_to_their_transport() -> None:
    for host in ("", "localhost", "127.0.0.1", "::1", "pc104.lan", ".zenoh", "fe80::1%eth0"):
        assert registry.transports.of_host(host).name == "tcp"
    assert registry.transports.of_host("a1b2.zenoh").name == "zenoh"


def test_a_stranger_leads_to_hosts_of_its_own() -> None:
    class Serial(Opener):
        name = "serial"
        hosts = ".serial"

    registry.transports.add("serial", Serial)
    try:
        assert registry.transports.of_host("ttyS0.serial").name == "serial"
    finally:
        registry.transports.remove("serial")
    assert registry.transports.of_host("ttyS0.serial").name == "tcp"
