"""From texts to a type: who is in whom, the checksum, and the full text that peers send each other.

Rules: `resolve` asks for the text of each type once. Cycles, types that nobody has, and types whose
smallest value would already be huge are DecodeErrors: a definition may come from a stranger. The
checksum and the full text are those of genmsg (`rosmsg md5`, `message_definition` of a connection).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import md5
from typing import Final

from yarpy.errors import DecodeError
from yarpy.limit import ROS_ALL_DECLARATIONS, ROS_DEPTH, ROS_PARTS, ROS_SMALLEST
from yarpy.peers.ros.message.model import PRIMITIVES, Constant, Field, ListOf, Struct, Type
from yarpy.peers.ros.message.parse import BUILTIN, FieldText, MessageText

_SEPARATOR: Final = "=" * 80 + "\n"


@dataclass(eq=False)
class Definition:
    """A message type with everything in it."""

    parsed: MessageText
    struct: Struct
    md5sum: str
    #: the message types of its fields, in their order
    used: tuple[Definition, ...] = field(repr=False)

    @property
    def name(self) -> str:
        return self.parsed.name

    @property
    def text(self) -> str:
        """The text of its file."""
        return self.parsed.text

    def all_used(self) -> Iterator[Definition]:
        """Every message type in it, each once, in the order of its full text."""
        seen = set()
        waiting = [*reversed(self.used)]
        while waiting:
            found = waiting.pop()
            if found.name not in seen:
                seen.add(found.name)
                yield found
                waiting += reversed(found.used)

    @cached_property
    def full_text(self) -> str:
        """Its text, and those of all types in it: the `message_definition` of a connection."""
        return full_text(self.parsed.text, self.all_used())


@dataclass(eq=False)
class ServiceDefinition:
    """A service type. ROS sums up both halves, one behind the other."""

    name: str
    text: str
    request: Definition
    response: Definition

    @cached_property
    def md5sum(self) -> str:
        return checksum(summed(self.request) + summed(self.response))

    @cached_property
    def full_text(self) -> str:
        halves = [*self.request.all_used(), *self.response.all_used()]
        return full_text(self.text, {used.name: used for used in halves}.values())


def full_text(text: str, used: Iterable[Definition]) -> str:
    """A text, and behind it those of the types in it."""
    parts = [text, *(f"{_SEPARATOR}MSG: {other.name}\n{other.parsed.text}" for other in used)]
    return "\n".join(parts)


def split_full_text(name: str, text: str) -> dict[str, str]:
    """The texts in a full text, by the names of their types; the first is that of `name`."""
    found: dict[str, str] = {}
    at = name
    for part in text.split("\n" + _SEPARATOR):
        if found:
            head, _, part = part.partition("\n")
            if not head.startswith("MSG: "):
                raise DecodeError(f"the definition of {name} has a part that names no type")
            at = head[5:].strip()
        found.setdefault(at, part)
    return found


def resolve(
    parsed: MessageText,
    find: Callable[[str, str], MessageText],
    known: dict[str, Definition],
    most: int = ROS_ALL_DECLARATIONS,
    sum_: Callable[[Definition], str] | None = None,
) -> Definition:
    """The type of a text. `find(name, within)` gives the texts of others or raises; what is in
    `known` is not asked for, what is found is put there. `most`: fields that are resolved. `sum_`:
    what types are told apart by, if not by the checksum of ROS 1."""
    return _Resolver(find, known, most, sum_ or _md5sum).resolve(parsed)


class _Resolver:
    def __init__(
        self,
        find: Callable[[str, str], MessageText],
        known: dict[str, Definition],
        most: int,
        sum_: Callable[[Definition], str],
    ) -> None:
        self.find = find
        self.known = known
        self.most = most
        self.sum = sum_
        self.path: list[str] = []
        self.declared = 0
        self.fields = 0

    def resolve(self, parsed: MessageText) -> Definition:
        if len(self.path) == ROS_DEPTH:
            raise DecodeError(f"{self.path[0]}: messages nested more than {ROS_DEPTH} deep")
        self.path.append(parsed.name)
        self.declared += len(parsed.fields) + len(parsed.constants)
        if self.declared > ROS_ALL_DECLARATIONS:
            raise DecodeError(
                f"{self.path[0]}: more than {ROS_ALL_DECLARATIONS} fields and constants, with "
                "those of the messages in it"
            )
        self.fields += len(parsed.fields)
        if self.fields > self.most:
            raise DecodeError(
                f"{self.path[0]}: more than {self.most} fields, with those of the messages in it"
            )
        used: dict[str, Definition] = {}
        fields = []
        for declared in parsed.fields:
            if declared.builtin is None and declared.base not in used:
                used[declared.base] = self._used(declared, parsed.name)
            type_ = _type(declared, used)
            fields.append(Field(declared.name, type_, declared.default, declared.doc))
        constants = tuple(
            Constant(item.name, PRIMITIVES[BUILTIN[item.spelled]], item.value, item.doc)
            for item in parsed.constants
        )
        struct = Struct(parsed.name, tuple(fields), constants, parsed.doc)
        _check(struct)
        self.path.pop()
        definition = Definition(parsed, struct, "", tuple(used.values()))
        definition.md5sum = self.sum(definition)
        return definition

    def _used(self, declared: FieldText, within: str) -> Definition:
        definition = self.known.get(declared.base)
        if definition is None:
            if declared.base in self.path:
                circle = " > ".join([*self.path[self.path.index(declared.base) :], declared.base])
                raise DecodeError(f"messages contain themselves: {circle}")
            definition = self.resolve(self.find(declared.base, within))
            definition = self.known.setdefault(declared.base, definition)
        return definition


def checksum(text: str) -> str:
    return md5(text.encode("utf-8", "surrogateescape")).hexdigest()


def _md5sum(definition: Definition) -> str:
    return checksum(summed(definition))


def summed(definition: Definition) -> str:
    """The text that the checksum is of."""
    sums = {used.name: used.md5sum for used in definition.used}
    lines = [f"{item.spelled} {item.name}={item.text}" for item in definition.parsed.constants]
    lines += [
        f"{sums.get(item.base, item.spelled)} {item.name}" for item in definition.parsed.fields
    ]
    return "\n".join(lines).strip()


def _type(declared: FieldText, used: dict[str, Definition]) -> Type:
    builtin = declared.builtin
    element: Type = PRIMITIVES[builtin] if builtin else used[declared.base].struct
    return ListOf(element, declared.length, declared.most) if declared.is_list else element


def _check(struct: Struct) -> None:
    """Nothing that takes no bytes may be counted by a peer, and nothing be huge while empty."""
    for item in struct.fields:
        element = item.type.element if isinstance(item.type, ListOf) else None
        if isinstance(element, Struct) and not element.smallest:
            raise DecodeError(
                f"{struct.name}.{item.name}: a list of {element}, which takes no bytes"
            )
    if struct.smallest > ROS_SMALLEST or struct.parts > ROS_PARTS:
        raise DecodeError(
            f"{struct.name} takes {struct.smallest} bytes while empty: its arrays are too large"
        )
