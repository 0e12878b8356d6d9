"""Command lines of YARP programs: `--key value value --flag` as a `Property`.

Rules (checked against C++ YARP): every argument is one value, so that
`--list "(1 2)"` is a list and `--text "a b"` one string; `--a::b 3` means `(a (b 3))`; backslashes
are literal; a later `--key` replaces an earlier one. Anything before the first `--` is not an
option and is skipped.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import DecodeError


def parse_options(arguments: Iterable[str]) -> Property:
    """The options of a command line.

    >>> parse_options(["--name", "/x", "--size", "3", "-4", "--flag"]).to_text()
    '(flag) (name "/x") (size 3 -4)'
    """
    groups: dict[str, Bottle] = {}
    current: Bottle | None = None
    for argument in arguments:
        if argument.startswith("--"):
            current = _open(groups, argument[2:]) if len(argument) > 2 else None
        elif current is not None:
            current.append(parse_value(argument))
    return Property.from_bottle(groups.values())


def parse_value(text: str) -> Any:
    """One value as C++ reads it from an argument: a number, list, vocab ..., else the text itself.

    >>> parse_value("3"), parse_value("(1 2)"), parse_value("a b")
    (3, Bottle([1, 2]), 'a b')
    """
    try:
        words = Bottle.from_text(text.replace("\\", "\\\\"))
    except DecodeError:
        return text
    # A word may contain commas, equal signs or quotes at which C++ would not split it here.
    one = len(words) == 1 and (type(words[0]) is not str or text.startswith('"'))
    return words[0] if one else text


def _open(groups: dict[str, Bottle], name: str) -> Bottle:
    """A new list for the values of `name`; `a::b` is the list b inside a."""
    path = name.split("::")
    if len(path) == 1:
        groups[name] = Bottle([name])
        return groups[name]
    outer = groups.setdefault(path[0], Bottle([path[0]]))
    for step in path[1:-1]:
        inner = next(
            (item for item in outer[1:] if isinstance(item, Bottle) and _is_called(item, step)),
            None,
        )
        if inner is None:
            inner = Bottle([step])
            outer.append(inner)
        outer = inner
    last = Bottle([path[-1]])
    outer[1:] = [*(i for i in outer[1:] if not _is_called(i, path[-1])), last]
    return last


def _is_called(item: Any, name: str) -> bool:
    return isinstance(item, Bottle) and bool(item) and plain_text(item[0]) == name
