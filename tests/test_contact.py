"""Addresses: the forms of C++ YARP, both ways."""

from __future__ import annotations

import doctest
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import yarpy
from yarpy import contact
from yarpy.contact import Contact, check_name, check_text, parse_contact
from yarpy.errors import AddressError


def test_examples_in_the_docstrings() -> None:
    found = doctest.testmod(contact)
    assert found.attempted >= 5
    assert found.failed == 0


FORMS = [
    # text, carrier, name, host, port
    ("/foo", "", "/foo", "", 0),
    ("tcp://foo", "tcp", "/foo", "", 0),
    ("tcp:/foo", "tcp", "/foo", "", 0),
    ("://foo", "", "/foo", "", 0),
    ("topic://news", "topic", "/news", "", 0),
    ("/127.0.0.1:10002", "tcp", "", "127.0.0.1", 10002),
    ("/127.0.0.1:10002/", "tcp", "", "127.0.0.1", 10002),
    ("tcp://127.0.0.1:10002", "tcp", "", "127.0.0.1", 10002),
    ("tcp://127.0.0.1:10002/", "tcp", "", "127.0.0.1", 10002),
    ("udp://host:10002/name", "udp", "/name", "host", 10002),
    ("127.0.0.1:10002", "tcp", "", "127.0.0.1", 10002),
    ("/foo:i", "", "/foo:i", "", 0),
    ("/foo:1", "tcp", "", "foo", 1),
    ("/foo:12/bar", "tcp", "/bar", "foo", 12),
    ("mjpeg+path.a/b.c?x=1://cam", "mjpeg+path.a/b.c?x=1", "/cam", "", 0),
    ("/[::1]:10002", "tcp", "", "::1", 10002),
    ("foo", "", "foo", "", 0),
    ("...", "", "...", "", 0),
]


@pytest.mark.parametrize(("text", "carrier", "name", "host", "port"), FORMS)
def test_forms(text: str, carrier: str, name: str, host: str, port: int) -> None:
    assert parse_contact(text) == Contact(carrier, name, host, port)


@pytest.mark.parametrize("text", ["", "/host:65536", "/host:99999999999", "tcp://h:70000"])
def test_what_is_no_address(text: str) -> None:
    with pytest.raises(AddressError):
        parse_contact(text)


@pytest.mark.parametrize("text", ["mqtt://broker:1883", "mqtt+sub+tls://b:1884/", "/mqtt://b:1"])
def test_a_broker_is_no_topic(text: str) -> None:
    with pytest.raises(AddressError, match="a broker without a topic: mqtt://HOST:PORT/TOPIC"):
        parse_contact(text)


@given(st.text(max_size=40))
def test_any_text_is_a_contact_or_an_address_error(text: str) -> None:
    try:
        found = parse_contact(text)
    except AddressError:
        return
    assert 0 <= found.port < 65536


@pytest.mark.parametrize(
    ("found", "text", "address", "reachable"),
    [
        (Contact("tcp", "/a", "host", 5), "tcp://a", "host:5", True),
        (Contact("", "/a"), "tcp://a", ":0", False),
        (Contact("udp", "", "host", 5), "udp://host:5/", "host:5", True),
        (Contact("tcp", "", "::1", 5), "tcp://[::1]:5/", "[::1]:5", True),
    ],
)
def test_contacts_as_text(found: Contact, text: str, address: str, reachable: bool) -> None:
    assert str(found) == text
    assert found.address == address
    assert found.reachable == reachable


GOOD = ["/a", "/a/b", "/a:i", "/a:1x", "/a b".replace(" ", "_"), "/\u00e4", "/" + "x" * 800]
BAD = ["", "a", "/a b", "/a\tb", "/a/", "/", "/a:1", "/a:1/b", "/" + "x" * 901, "/a\x00", "/a\x7f"]
BAD += ['/a"b', "/a\\b"]


@pytest.mark.parametrize("name", GOOD)
def test_names_of_ports(name: str) -> None:
    assert check_name(name) == name


@pytest.mark.parametrize("name", BAD)
def test_names_that_cannot_be(name: str) -> None:
    with pytest.raises(AddressError, match="a port name"):
        check_name(name)


@pytest.mark.parametrize(
    ("name", "instead"),
    [("/a/", "/a"), ("/a//", "/a"), ("/a b", "/a_b"), ("/a\n", "/a"), ("/a b/", "/a_b")],
)
def test_a_name_to_try_instead(name: str, instead: str) -> None:
    with pytest.raises(AddressError, match=f'C\\+\\+ YARP .*try "{instead}"'):
        check_name(name)
    assert check_name(instead) == instead


def test_long_name_is_not_repeated_in_full() -> None:
    with pytest.raises(AddressError) as caught:
        check_name("/" + "x" * 100_000)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize("name", [None, 5, b"/arm"])
def test_what_is_no_text(name: Any) -> None:
    for use in (parse_contact, yarpy.Port, yarpy.query, lambda name: yarpy.connect(name, "/b")):
        with pytest.raises(AddressError, match='a text such as "/arm", not '):
            use(name)


class Named:
    """What stands for a port that is given in place of its name."""

    name = "/arm/state"


@pytest.mark.parametrize("given", [None, 3, Named()])
def test_a_name_that_is_no_text(given: object) -> None:
    with pytest.raises(AddressError, match="the name of a port is a text") as caught:
        check_text(given)
    assert ('its name is a text: "/arm/state"' in str(caught.value)) == isinstance(given, Named)
