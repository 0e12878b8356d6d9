"""A line that a person typed, as a message.

Rules: it becomes what C++ makes of it, where unfinished and unbalanced parts vanish; but a person
is told, since a forgotten bracket would be a shorter command for the robot.
"""

from __future__ import annotations

from contextlib import suppress

import yarpy
from yarpy.cli.stderr import warn


def bottle(line: str) -> yarpy.Bottle:
    """Return the Bottle of a line of text, with a warning if some of it is not in there.

    Raises DecodeError for hundreds of brackets.
    """
    found = yarpy.Bottle.from_text(line)
    if line.count("(") == line.count(")") and line.count('"') % 2 == 0:
        return found
    why = ""
    with suppress(yarpy.DecodeError):
        why = _left_out(line, len(found))
    if why:
        warn(f"{why}: what is sent is {found.to_text() or 'empty'}")
    return found


def _left_out(line: str, length: int) -> str:
    """Return why elements of the line are missing in its Bottle, "" if none is."""
    missing = ")" * (line.count("(") - line.count(")"))
    for end, why in (
        (missing, 'a bracket "(" is not closed'),
        ('"' + missing, "a quotation mark is not closed"),
    ):
        if end and len(yarpy.Bottle.from_text(line + end)) > length:
            return why
    shorter = line.rstrip(") \t\r\n")
    if shorter.count("(") < line.count(")") and len(yarpy.Bottle.from_text(shorter)) > length:
        return 'there is a bracket ")" too many'
    return ""
