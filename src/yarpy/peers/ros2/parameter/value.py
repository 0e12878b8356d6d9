"""Values of parameters: Python's, and ROS 2's, which say their kind by a number.

Rules: pure. A list has elements of one kind: numbers with a fraction among them are all of that
kind. None is a parameter that is not set. `bytes` are a list of bytes; an empty list is one of
text.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

NOT_SET, BOOL, INTEGER, DOUBLE, STRING, BYTES, BOOLS, INTEGERS, DOUBLES, STRINGS = range(10)
#: the field of a ParameterValue for each kind
FIELDS: Final = (
    *("", "bool_value", "integer_value", "double_value", "string_value"),
    *("byte_array_value", "bool_array_value", "integer_array_value"),
    *("double_array_value", "string_array_value"),
)
#: as people call them
NAMES: Final = (
    *("not set", "bool", "integer", "double", "string"),
    *("byte array", "bool array", "integer array", "double array", "string array"),
)

Value = bool | int | float | str | bytes | list[bool] | list[int] | list[float] | list[str] | None


def kind_of(value: Any) -> int:
    """Return the number of the kind of a value. Raises TypeError for what can be no parameter."""
    if value is None:
        return NOT_SET
    if isinstance(value, bool | np.bool_):
        return BOOL
    if isinstance(value, int | np.integer):
        return INTEGER
    if isinstance(value, float | np.floating):
        return DOUBLE
    if isinstance(value, str):
        return STRING
    if isinstance(value, bytes | bytearray | memoryview):
        return BYTES
    if isinstance(value, Sequence | np.ndarray):
        kinds = {kind_of(item) for item in value}
        if not kinds:
            return STRINGS
        if kinds == {INTEGER, DOUBLE}:
            return DOUBLES
        if len(kinds) == 1 and (kind := kinds.pop()) in (BOOL, INTEGER, DOUBLE, STRING):
            return BOOLS + kind - BOOL
    raise TypeError(
        f"{value!r:.80} can be no parameter: those are bool, int, float, str, bytes, or a list of "
        "one of them"
    )


def plain(value: Any) -> Value:
    """Return a value as Python's own. Raises TypeError for what can be no parameter."""
    kind = kind_of(value)
    if kind in (BOOLS, INTEGERS, DOUBLES, STRINGS):
        make: Any = (bool, int, float, str)[kind - BOOLS]
        return [make(item) for item in value]
    if kind in (BOOL, INTEGER, DOUBLE, STRING, BYTES):
        made: Value = (bool, int, float, str, bytes)[kind - BOOL](value)
        return made
    return None


def to_ros(value: Any) -> dict[str, Any]:
    """Return a value as the fields of a ParameterValue. Raises TypeError."""
    kind = kind_of(value)
    return (
        {"type": kind, FIELDS[kind]: list(value) if kind == BYTES else plain(value)} if kind else {}
    )


def from_ros(value: Any) -> Value:
    """Return the value in a ParameterValue. Raises ValueError for a kind that there is not."""
    kind = value.type
    if kind == NOT_SET:
        return None
    if kind >= len(FIELDS):
        raise ValueError(f"a parameter of the kind {kind}, which there is not")
    found = getattr(value, FIELDS[kind])
    return bytes(bytearray(found)) if kind == BYTES else plain_list(found, kind)


def plain_list(found: Any, kind: int) -> Value:
    """Return what a field of that kind holds as Python's own value."""
    if kind < BYTES:
        return plain(found)
    make: Any = (bool, int, float, str)[kind - BOOLS]
    return [make(item) for item in found]


def named(values: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return values by name as the fields of Parameters. Raises TypeError."""
    return [{"name": name, "value": to_ros(value)} for name, value in values.items()]
