"""Several name services as one."""

import logging

import pytest
from support.name_line import serve_names
from support.port import free_port

from yarpy.contact import Contact
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.nameserver.local import LocalNames


def dead() -> YarpNameClient:
    return YarpNameClient("127.0.0.1", free_port(), 1.0)


def test_the_first_completes_and_all_know() -> None:
    other = LocalNames()
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as client:
        names = SeveralNames([client, other])
        assert names.allocates
        contact = names.register("...")
        assert contact == Contact("tcp", "/tmp/port/1", "127.0.0.1", 10002)
        assert other.query("/tmp/port/1") == contact
        names.unregister("/tmp/port/1")
        assert other.query("/tmp/port/1") is None


def test_queries_go_on_until_one_knows() -> None:
    one, two = LocalNames(), LocalNames()
    names = SeveralNames([one, two])
    assert not names.allocates
    two.register("/x", port=2)
    assert names.query("/x") == Contact("tcp", "/x", "127.0.0.1", 2)
    one.register("/x", port=1)
    assert names.query("/x") == Contact("tcp", "/x", "127.0.0.1", 1)
    assert names.query("/y") is None
    assert [contact.port for contact in names.list()] == [1]
    names.set("/x", "k", "v")
    assert names.get("/x", "k") == one.get("/x", "k") == ["v"]
    assert two.get("/x", "k") == []


def test_the_others_may_be_away(caplog: pytest.LogCaptureFixture) -> None:
    one = LocalNames()
    names = SeveralNames([one, dead()])
    with caplog.at_level(logging.WARNING, "yarpy.names"):
        names.register("/x", port=1)
        names.unregister("/x")
    assert [record.getMessage()[:25] for record in caplog.records] == [
        '"/x" is not registered ev',
        '"/x" is not unregistered ',
    ]
    assert one.query("/x") is None


def test_the_first_must_answer() -> None:
    other = LocalNames()
    names = SeveralNames([dead(), other])
    with pytest.raises(NoNameServer):
        names.register("/x", port=1)
    other.register("/y", port=1)
    assert names.query("/y") is not None
    with pytest.raises(NoNameServer):
        names.query("/x")
    with pytest.raises(NoNameServer):
        names.unregister("/y")
    assert other.query("/y") is None


def test_none_is_too_few() -> None:
    with pytest.raises(AddressError):
        SeveralNames([])
