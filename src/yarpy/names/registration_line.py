"""The text lines that name servers and their clients exchange.

Rules: pure. A registration is the one line that every client parses (C++ by word position). Names
may contain blanks and nothing is quoted, so we parse it from both ends.
"""

from __future__ import annotations

import re

from yarpy.contact import Contact
from yarpy.log import readable

PREFIX = "NAME_SERVER "
END = "*** end of message"
LONGEST = 1 << 20  # bytes of one line, in either direction

_REGISTRATION = re.compile(r"registration name (.*) ip (\S*) port (-?\d{1,10}) type (.*)", re.S)
_PLAIN = re.compile(r"[^\"\\\r\n\0]*")


def registration_line(contact: Contact) -> str:
    """`registration name N ip H port P type C`, as the reply to `query`.

    >>> registration_line(Contact("tcp", "/cam", "10.0.0.1", 10002))
    'registration name /cam ip 10.0.0.1 port 10002 type tcp'
    """
    return (
        f"registration name {plain(contact.name)} ip {plain(contact.host)} "
        f"port {contact.port} type {plain(contact.carrier)}"
    )


def parse_registration(line: str) -> Contact | None:
    """The contact in a registration line, or None for any other line.

    >>> parse_registration("registration name /a b ip 10.0.0.1 port 10002 type tcp").name
    '/a b'
    """
    match = _REGISTRATION.fullmatch(line.strip())
    if match is None:
        # An empty carrier leaves nothing behind "type".
        match = _REGISTRATION.fullmatch(line.strip() + " ")
    if match is None:
        return None
    name, host, number, carrier = match.groups()
    port = int(number)
    if not 0 <= port <= 65535 or readable(line.strip()) != line.strip():
        return None
    return Contact(carrier.strip(), name, host, port)


def plain(text: str) -> str:
    """A word as C++ writes it into a line: escaped like a quoted string, then without the quotes.

    >>> plain('say "hi"' + chr(10))
    'say \\\\hi\\\\\\\\n'
    """
    if _PLAIN.fullmatch(text):
        return text
    for raw, escaped in (("\\", "\\\\"), ('"', "\\"), ("\n", "\\n"), ("\r", "\\r"), ("\0", "\\0")):
        text = text.replace(raw, escaped)
    return text
