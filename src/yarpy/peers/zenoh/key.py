"""Key expressions under which ports are found over Zenoh, and what is answered there.

    @yarp/root/port/ZID/START/NAME      token: the port exists; NAME is one chunk, START its age
    @yarp/root/name/robot/head          question: where /robot/head is; `?key=ips`: a property
    @yarp/root/node/ZID/N               question: all ports of a program

A port is told of in three lines, those of a program one after the other:

    registration name /robot/head ip 127.0.0.1 port 10002 type tcp
    session ZID START MACHINE INSIDE
    addresses 192.168.1.7 10.0.0.1

Rules: pure. `root` is the namespace. What comes from the network is checked and limited here; what
is wrong with it is a DecodeError. Of two ports that have one name the one that started later counts
(of equals: that of the greater session), so that all who see both agree.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final
from urllib.parse import quote, unquote

from yarpy.contact import Contact, check_name
from yarpy.errors import AddressError, DecodeError
from yarpy.limit import ZENOH_ALL_PORTS
from yarpy.names.registration_line import parse_registration, registration_line
from yarpy.peers.zenoh.address import zid_host

PREFIX: Final = "@yarp"
LONGEST: Final = 1 << 16  # bytes of what is said of one port
ADDRESSES: Final = 32  # of one port

_SAFE: Final = "!&'()+,;=:~-._[]{}^|<>\"\\`"  # all but what Zenoh gives a meaning: % * $ ? # @ /
_SESSION = re.compile(r"session ([0-9a-f]{1,32}) ([0-9a-f]{1,16}) ([0-9a-f]{1,32}) (\d{1,5})")
_ADDRESS = re.compile(r"[0-9A-Za-z.:_-]{1,255}")
_PROPERTY = re.compile(r"[0-9A-Za-z_.-]{1,100}")


@dataclass(frozen=True, slots=True)
class Entry:
    """A port, as its program tells of it.

    contact: where it listens, as it was registered. zid: its program's session. start: when it was
    registered, in ns since 1970. machine: tells its computer, or container, from others.
    inside: its number for those who come through Zenoh. addresses: those of that computer by which
    others reach it.
    """

    contact: Contact
    zid: str
    start: int
    machine: str
    inside: int
    addresses: tuple[str, ...] = ()

    @property
    def age(self) -> tuple[int, str]:
        """Greater for the port that has the name, of two."""
        return self.start, self.zid

    @property
    def through(self) -> Contact:
        """The port's address inside Zenoh."""
        return Contact(self.contact.carrier, self.contact.name, zid_host(self.zid), self.inside)

    @property
    def port(self) -> int:
        """Its TCP port number."""
        return self.contact.port


# -- keys -----------------------------------------------------------------------------------------


def space(namespace: str = "/root") -> str:
    """Return the prefix of all keys of a namespace.

    >>> space("/root")
    '@yarp/root'
    """
    return f"{PREFIX}/{_chunk(namespace.strip('/') or 'root')}"


def name_key(base: str, name: str) -> str:
    """Return the key under which a name is asked for.

    >>> name_key("@yarp/root", "/icub/head*")
    '@yarp/root/name/icub/head%2A'

    Raises AddressError for what cannot be a name.
    """
    check_name(name)
    # An empty chunk is none of Zenoh's.
    return f"{base}/name/" + "/".join(_chunk(part) or "%" for part in name[1:].split("/"))


def port_token(base: str, entry: Entry) -> str:
    """The token of a port."""
    return f"{base}/port/{entry.zid}/{entry.start:x}/{_chunk(entry.contact.name)}"


def is_property(key: str) -> bool:
    """Return whether `key` can name a property."""
    return _PROPERTY.fullmatch(key) is not None


# -- what is said there ---------------------------------------------------------------------------


def encode(entries: Iterable[Entry]) -> bytes:
    """Ports, three lines each."""
    lines: list[str] = []
    for entry in entries:
        lines.append(registration_line(replace(entry.contact, name=_word(entry.contact.name))))
        lines.append(f"session {entry.zid} {entry.start:x} {entry.machine} {entry.inside}")
        lines.append(f"addresses {' '.join(entry.addresses[:ADDRESSES])}".rstrip())
    return "\n".join(lines).encode("utf-8", "surrogateescape")


def decode(data: bytes, limit: int = ZENOH_ALL_PORTS) -> list[Entry]:
    """The ports in an answer. Raises DecodeError."""
    if len(data) > limit:
        raise DecodeError(f"{len(data)} bytes of names, more than {limit}")
    try:
        lines = data.decode().split("\n") if data else []
    except UnicodeDecodeError as error:
        raise DecodeError("names that are no text") from error
    if len(lines) % 3:
        raise DecodeError(f"{len(lines)} lines about ports, not three for each")
    return [_entry(*lines[i : i + 3]) for i in range(0, len(lines), 3)]


def _entry(first: str, second: str, third: str) -> Entry:
    contact = parse_registration(first)
    session = _SESSION.fullmatch(second)
    word, *addresses = third.split(" ")
    fine = word == "addresses" and len(addresses) <= ADDRESSES
    if contact is None or session is None or not (fine and all(map(_ADDRESS.fullmatch, addresses))):
        raise DecodeError(f"not what a port says of itself: {first[:80]!r}")
    try:
        name = check_name(unquote(contact.name, errors="strict"))
    except (AddressError, UnicodeDecodeError) as error:
        raise DecodeError(str(error)) from error
    zid, start, machine, inside = session.groups()
    contact = replace(contact, name=name)
    return Entry(contact, zid, int(start, 16), machine, int(inside), tuple(addresses))


def newest(entries: Iterable[Entry], name: str) -> Entry | None:
    """The port that has a name, of those that say so."""
    return max((e for e in entries if e.contact.name == name), key=lambda e: e.age, default=None)


def _word(name: str) -> str:
    """A name within a line, where quotes and backslashes have a meaning of their own."""
    return quote(name, safe="/!&'()+,;=:~-._[]{}^|<>", errors="surrogateescape")


def _chunk(text: str) -> str:
    return quote(text, safe=_SAFE, errors="surrogateescape")
