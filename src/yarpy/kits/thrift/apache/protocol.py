"""Values of both protocols: sorts of values, heads of messages, and why a call failed.

    sort        the byte that TBinaryProtocol has for a type
    Head        of a message: its kind, the method, the number by which its answer is known
    Fault       a TApplicationException: why a call has no result

Rules: pure values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import Kind, ListOf, MapOf, Scalar, SetOf, is_enum, name_of

STOP: Final = 0
BOOL: Final = 2
BYTE: Final = 3
DOUBLE: Final = 4
I16: Final = 6
I32: Final = 8
I64: Final = 10
STRING: Final = 11
STRUCT: Final = 12
MAP: Final = 13
SET: Final = 14
LIST: Final = 15
UUID: Final = 16

CALL: Final = 1
REPLY: Final = 2
EXCEPTION: Final = 3
ONEWAY: Final = 4

# Why a call has no result, as TApplicationException numbers it.
UNKNOWN: Final = 0
UNKNOWN_METHOD: Final = 1
MISSING_RESULT: Final = 5
INTERNAL_ERROR: Final = 6
PROTOCOL_ERROR: Final = 7

_SORTS: Final = {
    kinds.BOOL: BOOL, kinds.I8: BYTE, kinds.UI8: BYTE, kinds.I16: I16, kinds.UI16: I16,
    kinds.I32: I32, kinds.UI32: I32, kinds.SIZE: I32, kinds.VOCAB: I32, kinds.I64: I64,
    kinds.UI64: I64, kinds.FLOAT: DOUBLE, kinds.DOUBLE: DOUBLE, kinds.TEXT: STRING,
    kinds.BINARY: STRING,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Head:
    """The beginning of a message. `kind`: CALL, REPLY, EXCEPTION or ONEWAY."""

    kind: int
    name: str
    number: int


class Fault(RemoteProtocolError):
    """A call that has no result, as a TApplicationException says it. `kind`: one of its numbers,
    such as UNKNOWN_METHOD."""

    def __init__(self, kind: int, text: str) -> None:
        super().__init__(text)
        self.kind = kind
        self.text = text


def sort_of(kind: Kind) -> int:
    """Return the sort of a kind. Raises TypeError for what only YARP's wire has."""
    if isinstance(kind, Scalar):
        return _SORTS[kind]
    if isinstance(kind, ListOf):
        return LIST
    if isinstance(kind, SetOf):
        return SET
    if isinstance(kind, MapOf):
        return MAP
    if isinstance(kind, type):
        return I32 if is_enum(kind) else STRUCT
    raise TypeError(
        f"{name_of(kind)} is a type of YARP that no protocol of Apache has: use a struct without "
        "yarp.name"
    )
