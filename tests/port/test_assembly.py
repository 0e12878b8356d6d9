"""Opening a hub: it listens, is registered, and everybody who acts on hubs acts on this one."""

from __future__ import annotations

import pytest
from support.port import free_port

from yarpy.errors import AddressError
from yarpy.nameserver.local import LocalNames
from yarpy.port.assembly import open_hub
from yarpy.port.connect import probe
from yarpy.port.mailbox import Latest


def test_open_hub_answers_whoever_asks(names: LocalNames) -> None:
    hub = open_hub("/here", Latest(), names)
    try:
        contact = names.query("/here")
        assert contact is not None and contact.port == hub.port
        assert probe.ask(contact, ["ver"])[0] == "ver"
        assert probe.describe(contact)[0].startswith("This is /here at ")
    finally:
        hub.close()
    assert names.query("/here") is None


def test_number_of_the_environment_is_taken_unless_one_is_given(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    number, other = free_port(), free_port()
    monkeypatch.setenv("YARP_PORTNUMBER_here", str(number))
    hub = open_hub("/here", Latest(), names)
    assert hub.port == number
    hub.close()
    hub = open_hub("/here", Latest(), names, tcp_port=other)
    assert hub.port == other
    hub.close()


def test_hub_that_cannot_listen_is_not_registered(names: LocalNames) -> None:
    with pytest.raises(AddressError, match="below 65536"):
        open_hub("/here", Latest(), names, tcp_port=70000)
    assert names.query("/here") is None
