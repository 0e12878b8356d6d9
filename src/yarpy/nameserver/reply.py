"""Replies of a name server: the two styles, and how each is built.

Rules: pure. Old style is lines ended by `*** end of message`, each a Bottle without any double
quotes; the other style is one Bottle.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.names.registration_line import END, registration_line
from yarpy.nameserver.topology import Action

# A text that no reader takes for anything but a word (as it might null, inf and numbers).
_WORD = re.compile(r"[A-Za-hj-mo-z][A-Za-z0-9_]*+")

HELP_HEADING = "Here are some ways to use the name server:"
HELP = (
    "+ help",
    "+ list [$prefix]",
    "+ register $portname",
    "+ register $portname $carrier $ipAddress $portNumber",
    "  (if you want a field set automatically, write '...')",
    "+ unregister $portname",
    "+ query $portname",
    "+ set $portname $property $value",
    "+ get $portname $property",
    "+ check $portname $property",
    "+ route $port1 $port2",
    "+ runners",
    "  (to get a list of the yarprun ports)",
)


@dataclass(frozen=True, slots=True)
class Reply:
    """The reply to a command, and what else follows from it.

    `lines`: an old style reply with its end line; empty for a Bottle style one, which is in
    `bottle`. `events`: Bottles for everybody connected to the server's output. `actions`:
    connections to make or break in the background, in this order for each pair of ports.
    """

    lines: tuple[str, ...] = ()
    bottle: Bottle | None = None
    events: tuple[Bottle, ...] = ()
    actions: tuple[Action, ...] = ()

    def text_lines(self) -> tuple[str, ...]:
        """The lines for a text connection, either style, without their ends."""
        return self.lines if self.bottle is None else (self.bottle.to_text(),)

    def to_bytes(self) -> bytes:
        """The same with CR LF: what C++ sends even on binary connections, for old style."""
        text = "".join(f"{line}\r\n" for line in self.text_lines())
        return text.encode("utf-8", "surrogateescape")

    def message(self) -> Bottle:
        """For a binary connection: an old style reply becomes a Bottle of one string.

        C++ sends raw text there, which no binary reader can digest.
        """
        if self.bottle is not None:
            return self.bottle
        return Bottle(["".join(f"{line}\r\n" for line in self.lines)])

    def first(self) -> Bottle:
        """The Bottle, or the first line read as one: what HTTP turns into JSON."""
        if self.bottle is not None:
            return self.bottle
        return Bottle.from_text(self.lines[0])


def port_bottle(contact: Contact | None) -> Bottle:
    """`port (name N) (ip H) (port_number P) (carrier C)`, or that it is not known."""
    if contact is None:
        return Bottle(["port", Bottle(["error", -2, "port not known"])])
    return Bottle(
        [
            "port",
            Bottle(["name", contact.name]),
            Bottle(["ip", contact.host]),
            Bottle(["port_number", contact.port]),
            Bottle(["carrier", contact.carrier]),
        ]
    )


def old(
    lines: Iterable[str], events: Sequence[Bottle] = (), actions: Sequence[Action] = ()
) -> Reply:
    """An old style reply; the end line is added here."""
    return Reply((*lines, END), None, tuple(events), tuple(actions))


def ok(actions: Sequence[Action] = ()) -> Reply:
    """`[ok]`, and what follows from it."""
    return Reply(bottle=Bottle([Vocab("ok")]), actions=tuple(actions))


def fail(*reason: str) -> Reply:
    """`[fail]`, with a word about why where C++ has none."""
    return Reply(bottle=Bottle([Vocab("fail"), *reason]))


def found(contact: Contact | None, nested: bool) -> Reply:
    """One port or none; `nested` asks for a Bottle."""
    if nested:
        return Reply(bottle=port_bottle(contact))
    return old(() if contact is None else [registration_line(contact)])


def every(contacts: Iterable[Contact], nested: bool) -> Reply:
    """Any number of ports."""
    if nested:
        return Reply(bottle=Bottle(["ports", *map(port_bottle, contacts)]))
    return old(map(registration_line, contacts))


def properties(name: str, key: str, values: list[str] | None, nested: bool) -> Reply:
    """The values of a property; None: there is no such port."""
    if nested:
        return Reply(bottle=Bottle(value_of(value) for value in values or () if value))
    if values is None:
        return old(())
    return old([unquoted(["port", name, "property", key, "=", *values])])


def value_of(text: str) -> Any:
    """A stored property as the value that its text spells; what is not one value stays text."""
    if _WORD.fullmatch(text) and text not in ("true", "false"):
        return text
    try:
        parsed = Bottle.from_text(text)
    except DecodeError:
        return text
    # A word stays as it is: C++ would take its quotes and backslashes off once more.
    return parsed[0] if len(parsed) == 1 and type(parsed[0]) is not str else text


def unquoted(items: list[Any]) -> str:
    """A line of old style: the Bottle's text without any double quote."""
    return Bottle(items).to_text().replace('"', "")


def broken(bottle: Bottle) -> list[str]:
    """A Bottle reply forced into lines, one for each element, as C++ does for `bot register`."""
    return [unquoted(item if isinstance(item, list) else [item]) for item in bottle]
