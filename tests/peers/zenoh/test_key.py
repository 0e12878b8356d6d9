"""What ports say of themselves over Zenoh, as text."""

from __future__ import annotations

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.contact import Contact, check_name
from yarpy.errors import AddressError, DecodeError
from yarpy.peers.zenoh import key
from yarpy.peers.zenoh.key import Entry

HEAD = Entry(
    Contact("tcp", "/icub/head", "10.0.0.1", 10002), "a1b2", 255, "c3", 7, ("10.0.0.1", "::2")
)
LINES = (
    b"registration name /icub/head ip 10.0.0.1 port 10002 type tcp\n"
    b"session a1b2 ff c3 7\n"
    b"addresses 10.0.0.1 ::2"
)


def named(name: str) -> Entry:
    return Entry(Contact("tcp", name, "10.0.0.1", 1), "ab", 1, "c", 1)


def is_name(text: str) -> bool:
    try:
        return bool(check_name(text))
    except AddressError:
        return False


def test_golden() -> None:
    assert key.space() == "@yarp/root"
    assert key.space("/lab/b") == "@yarp/lab%2Fb"
    assert key.name_key("@yarp/root", "/icub/head") == "@yarp/root/name/icub/head"
    assert key.port_token("@yarp/root", HEAD) == "@yarp/root/port/a1b2/ff/%2Ficub%2Fhead"
    assert key.encode([HEAD]) == LINES
    assert key.decode(LINES + b"\n" + LINES) == [HEAD, HEAD]
    assert key.decode(b"") == []
    assert HEAD.through == Contact("tcp", "/icub/head", "a1b2.zenoh", 7)


@given(st.text(string.printable + "é*$?#@%\u2028", min_size=1, max_size=20).map("/".__add__))
def test_every_name_is_a_key_of_its_own(name: str) -> None:
    if not is_name(name):
        return
    for text in (key.name_key("@yarp/root", name), key.port_token("@yarp/root", named(name))):
        assert not set(text[len("@yarp") :]) & set("*$?#@") and "//" not in text
    assert key.decode(key.encode([named(name)])) == [named(name)]


@given(st.text(max_size=30), st.text(max_size=30))
def test_no_name_is_read_as_wild_cards(one: str, other: str) -> None:
    if one != other and is_name(f"/{one}") and is_name(f"/{other}"):
        assert key.name_key("@yarp/root", f"/{one}") != key.name_key("@yarp/root", f"/{other}")


@pytest.mark.parametrize("name", ["a", "", "/a b", "/a/", "/" + 901 * "x", "/a\n"])
def test_what_cannot_be_a_name(name: str) -> None:
    with pytest.raises(AddressError):
        key.name_key("@yarp/root", name)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"10002", b"70000"),
        (b"/icub/head", b"icub"),
        (b"/icub/head", b"/%FF"),
        (b"/icub/head", b"/%0A"),
        (b"a1b2", b"A1B2"),
        (b"a1b2", b"../x"),
        (b" ff ", b" 11223344556677889 "),
        (b"10.0.0.1 ::2", b"10.0.0.1  ::2"),
        (b"::2", b"::2" * 1000),
        (b"::2", b" ".join([b"::2"] * 33)),
        (b"addresses", b"address"),
        (b"\nsession", b" session"),
        (b"tcp", b"\xff"),
    ],
)
def test_what_no_port_says(old: bytes, new: bytes) -> None:
    with pytest.raises(DecodeError):
        key.decode(LINES.replace(old, new))


def test_no_more_than_is_allowed() -> None:
    with pytest.raises(DecodeError, match="more than"):
        key.decode(LINES, limit=20)


@given(st.binary(max_size=60), st.integers(0, len(LINES)))
def test_mutants_are_refused_or_read(piece: bytes, place: int) -> None:
    try:
        found = key.decode(LINES[:place] + piece + LINES[place:])
    except DecodeError:
        return
    assert all(is_name(entry.contact.name) for entry in found)


def test_the_newer_port_has_the_name() -> None:
    older, newer = named("/x"), Entry(Contact("tcp", "/x", "h", 2), "aa", 2, "c", 1)
    greater = Entry(Contact("tcp", "/x", "h", 3), "ff", 1, "c", 1)
    assert key.newest([older, newer, named("/y")], "/x") is newer
    assert key.newest([greater, older], "/x") is greater
    assert key.newest([], "/x") is None


def test_properties() -> None:
    assert key.is_property("ips") and not key.is_property("a;b") and not key.is_property("")
