"""Names without a server."""

import pytest

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.names.base import NameClient
from yarpy.nameserver.local import LocalNames


def test_is_a_name_client() -> None:
    assert isinstance(LocalNames(), NameClient)
    assert not LocalNames().allocates


def test_register_query_unregister() -> None:
    names = LocalNames()
    assert names.register("/x", port=41000) == Contact("tcp", "/x", "127.0.0.1", 41000)
    assert names.register("/y", "udp", "10.0.0.1", 5).host == "10.0.0.1"
    assert names.register("...", port=41001).name == "/tmp/port/1"
    assert names.query("/x") == Contact("tcp", "/x", "127.0.0.1", 41000)
    assert [contact.name for contact in names.list()] == ["/tmp/port/1", "/x", "/y"]
    assert [contact.name for contact in names.list("/tmp")] == ["/tmp/port/1"]
    names.announce("/x")
    names.unregister("/x")
    names.unregister("/x")
    assert names.query("/x") is None
    names.close()


def test_a_number_is_needed_except_for_groups() -> None:
    names = LocalNames()
    with pytest.raises(AddressError, match="listen first"):
        names.register("/x")
    assert names.register("...", "mcast").host == "224.1.1.3"


def test_properties() -> None:
    names = LocalNames()
    names.register("/x", port=1)
    assert names.set("/x", "k", "b", 1, 2.5) == ["1", "2.5", "b"]
    assert names.get("/x", "k") == ["1", "2.5", "b"]
    assert names.get("/x", "other") == names.get("/nope", "k") == names.set("/nope", "k", 1) == []


def test_worlds_are_apart() -> None:
    one, other = LocalNames(), LocalNames()
    one.register("/x", port=1)
    assert other.query("/x") is None
