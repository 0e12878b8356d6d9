"""The arguments of a query or of a form: read, put in the place of `$name`, and as numbers.

Rules: pure functions of text. What an argument may add to a message is limited.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from yarpy.errors import DecodeError
from yarpy.limit import HTTP_FIELDS, HTTP_FILLED

_VARIABLE = re.compile(r"\$([A-Za-z0-9_]*)")
#: How text within quotes spells what would end them, or change within them.
_IN_QUOTES = str.maketrans({"\\": r"\\", '"': r"\"", "\n": r"\n", "\r": r"\r", "\0": r"\0"})


def read_fields(query: str) -> dict[str, str]:
    """The arguments of a query or of a form; those without a name or a value do not count."""
    pairs = query.split("&")
    if len(pairs) > HTTP_FIELDS:
        raise DecodeError(f"more than {HTTP_FIELDS} arguments")
    found = {}
    for pair in pairs:
        key, _, value = pair.partition("=")
        key, value = decoded(key), decoded(value)
        if key and value:
            found[key] = value
    return found


def substitute(text: str, fields: Mapping[str, str]) -> str:
    """`text` with each `$name` replaced by the argument of that name, or by nothing.

    `"$name"` in quotes stays one text, whatever quotes and backslashes the argument has.
    DecodeError if that would add more than HTTP_FILLED characters."""
    left = HTTP_FILLED

    def value(match: re.Match[str]) -> str:
        nonlocal left
        found = fields.get(match[1], "")
        if text[match.start() - 1 : match.start()] == text[match.end() : match.end() + 1] == '"':
            found = found[: HTTP_FILLED + 1].translate(_IN_QUOTES)
        left -= len(found)
        if left < 0:  # before it is built: many short names may repeat a long argument
            raise DecodeError(f"arguments that expand to more than {HTTP_FILLED} characters")
        return found

    return _VARIABLE.sub(value, text)


def number_of(name: str, fields: Mapping[str, str], least: float, most: float) -> float:
    """The number that a field holds, 0 where there is no such field. Raises ValueError."""
    text = fields.get(name)
    if text is None:
        return 0.0
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not least <= value <= most:
        raise ValueError(f"{name} must be a number from {least:g} to {most:g}, not {text[:40]!r}")
    return value


def decoded(text: str) -> str:
    """Return the text that a part of a URL or of a form stands for."""
    from urllib.parse import unquote_plus

    return unquote_plus(text, errors="surrogateescape")
