"""A type as `rosmsg show` and `rossrv show` print it: constants, then fields, with those of the
messages in it indented below.

Rules: no comments. What two types share is printed in both places, up to a number of lines.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Final

from yarpy.peers.ros.message.definition import Definition, ServiceDefinition
from yarpy.peers.ros.message.parse import FieldText

#: messages that contain others twice, again and again, have short definitions and long listings
MAX_LINES: Final = 10_000


def show(definition: Definition | ServiceDefinition) -> str:
    """The lines of a type, without a line end behind the last."""
    if isinstance(definition, Definition):
        return "\n".join(_limited(definition))
    return "\n".join([*_limited(definition.request), "---", *_limited(definition.response)])


def _limited(definition: Definition) -> list[str]:
    lines = [*islice(_lines(definition, ""), MAX_LINES + 1)]
    return [*lines[:MAX_LINES], "..."] if len(lines) > MAX_LINES else lines


def _lines(definition: Definition, indent: str) -> Iterator[str]:
    used = {other.name: other for other in definition.used}
    for constant in definition.parsed.constants:
        yield f"{indent}{constant.spelled} {constant.name}={constant.text}"
    for field in definition.parsed.fields:
        yield f"{indent}{_type(field)} {field.name}"
        if field.base in used:
            yield from _lines(used[field.base], indent + "  ")


def _type(field: FieldText) -> str:
    """The type as ROS prints it, with its package."""
    if field.builtin:
        return field.spelled
    brackets = f"[{'' if field.length is None else field.length}]" if field.is_list else ""
    return field.base + brackets
