"""Loggers whose records are safe to read in a terminal.

    log = logger("yarpy.port")

Rules: names, addresses and reasons come from strangers, and a terminal obeys the control characters
in what it shows. So what a terminal would obey, what ends a line, and what turns the direction of a
text around is escaped in every record, whatever handler takes it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import logging

# Control characters (of ASCII and C1), marks of direction, ends of lines.
_HIDDEN: Final = re.compile(r"[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
_SHORT: Final = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}


def logger(name: str) -> logging.Logger:
    """The logger of that name. What it logs is `readable`."""
    import logging  # late: `readable` alone does not need it

    found = logging.getLogger(name)
    found.addFilter(_make_readable)  # once, however often
    return found


def readable(text: str, keep: str = "") -> str:
    """`text` with escapes in place of unseen characters that terminals and line readers obey.

    >>> readable("/cam" + chr(27) + "[2J" + chr(10))
    '/cam\\\\x1b[2J\\\\n'
    >>> readable("two" + chr(10) + "lines", keep=chr(10)) == "two" + chr(10) + "lines"
    True
    """
    return _HIDDEN.sub(lambda match: match[0] if match[0] in keep else _escaped(match[0]), text)


def _escaped(letter: str) -> str:
    code = ord(letter)
    return _SHORT.get(letter) or (f"\\x{code:02x}" if code < 256 else f"\\u{code:04x}")


def _make_readable(record: logging.LogRecord) -> bool:
    try:
        text = record.getMessage()
    except Exception:
        return True  # the handler reports what is wrong with it
    if _HIDDEN.search(text) is not None:
        record.msg, record.args = readable(text), ()
    return True
