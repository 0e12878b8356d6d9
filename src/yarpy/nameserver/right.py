"""The rights that a command to the name service takes, where `access.toml` has rules.

Rules: pure. Every peer that a rule mentions may ask where ports are. To register a name, to change
it or to take it out needs `register` for that name, and for the names that go with it (`owns`);
topics and persistent connections, which let other ports be connected, need `administer` for the
name server.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from yarpy.data.text import plain_text
from yarpy.nameserver.command import without_request

_OWN: Final = frozenset(("register", "unregister", "set", "announce"))
_RULES: Final = frozenset(("unsubscribe", "untopic", "gc"))
# These ask with so many words, and change something with more.
_ASKING: Final = {"subscribe": 2, "topic": 1, "type": 3}


def needed(command: Sequence[Any]) -> list[tuple[str, str]]:
    """The rights that a command needs, each with the name that it is for; "" for the name server's
    own. Empty: it only asks."""
    words, _ = without_request(command)
    while words and plain_text(words[0]) in ("NAME_SERVER", "bot"):
        del words[0]
    if not words:
        return []
    verb = plain_text(words[0])
    if verb in _RULES or len(words) > _ASKING.get(verb, len(words)):
        return [("administer", "")]
    if verb not in _OWN or (verb == "announce" and len(words) > 2 and not words[2]):
        return []  # a complaint about a port that does not answer is looked into
    names = [_name(words, 1)]
    if verb == "set" and plain_text(words[2] if len(words) > 2 else "") == "owns":
        names += [plain_text(word) for word in words[3:]]
    return [("register", name) for name in names]


def is_old_style(command: Sequence[Any]) -> bool:
    """Return whether the answer to a change is lines, not a Bottle."""
    first = plain_text(command[0]) if command else ""
    return first in _OWN - {"announce"} or first in ("NAME_SERVER", "gc")


def _name(words: Sequence[Any], place: int) -> str:
    """The name that a command is about, `...` for one that the server is to make up."""
    word = words[place] if len(words) > place else ""
    name = plain_text(word) if isinstance(word, (str, bool)) else ""
    return "..." if not name or name.startswith("=") else name
