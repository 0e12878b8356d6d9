"""A `.thrift` file, declaration by declaration, as it is spelled and nothing looked up.

Rules: values without behaviour; each knows its line. Values of constants and defaults are Python
objects, a name in them is a `Name`, a map a list of pairs.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

Annotations: TypeAlias = dict[str, str]


@dataclass(frozen=True, slots=True)
class Name:
    """A constant or an enum's, mentioned in a value: `Color.RED`."""

    text: str
    line: int = 0


@dataclass(frozen=True, slots=True)
class Pairs:
    """A map, or the fields of a struct."""

    items: tuple[tuple[Any, Any], ...]


@dataclass(frozen=True, slots=True)
class TypeText:
    """`name` is `i32`, `list`, `geometry.Point`; `inner` the types between its brackets."""

    name: str
    inner: tuple[TypeText, ...] = ()
    annotations: Annotations = field(default_factory=dict)
    line: int = 0


@dataclass(frozen=True, slots=True)
class FieldText:
    """A field or an argument. `default` is None where there is none. `need` is `required`,
    `optional` or "". `reference`: it has a `&`, as fields of structs that contain themselves."""

    name: str
    type: TypeText
    number: int | None = None
    default: Any = None
    annotations: Annotations = field(default_factory=dict)
    doc: str = ""
    line: int = 0
    need: str = ""
    reference: bool = False


@dataclass(frozen=True, slots=True)
class ConstText:
    name: str
    type: TypeText
    value: Any
    doc: str = ""
    line: int = 0


@dataclass(frozen=True, slots=True)
class TypedefText:
    name: str
    type: TypeText
    doc: str = ""
    line: int = 0


@dataclass(frozen=True, slots=True)
class ValueText:
    """A constant of an enum."""

    name: str
    number: int
    doc: str = ""
    line: int = 0


@dataclass(frozen=True, slots=True)
class EnumText:
    name: str
    values: tuple[ValueText, ...]
    annotations: Annotations = field(default_factory=dict)
    doc: str = ""
    line: int = 0


@dataclass(frozen=True, slots=True)
class StructText:
    """A struct, a union or an exception, as `sort` says."""

    name: str
    fields: tuple[FieldText, ...]
    annotations: Annotations = field(default_factory=dict)
    doc: str = ""
    line: int = 0
    sort: str = "struct"

    def may_lack(self, each: FieldText) -> bool:
        """Return whether a field may have no value."""
        if each.default is not None:
            return False
        return each.need == "optional" or each.reference or self.sort == "union"


@dataclass(frozen=True, slots=True)
class MethodText:
    """`result` is None for void."""

    name: str
    result: TypeText | None
    arguments: tuple[FieldText, ...]
    oneway: bool = False
    annotations: Annotations = field(default_factory=dict)
    doc: str = ""
    line: int = 0
    throws: tuple[FieldText, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceText:
    name: str
    extends: str
    methods: tuple[MethodText, ...]
    annotations: Annotations = field(default_factory=dict)
    doc: str = ""
    line: int = 0


def numbered(fields: tuple[FieldText, ...]) -> tuple[int, ...]:
    """Return the numbers of fields; one that has none gets the next below 0, as Apache does."""
    found, below = [], 0
    for each in fields:
        if each.number is None:
            below -= 1
        found.append(below if each.number is None else each.number)
    return tuple(found)


Declaration: TypeAlias = ConstText | TypedefText | EnumText | StructText | ServiceText


@dataclass(frozen=True, slots=True)
class Document:
    """A file. `includes`: the paths as written, with their lines; `namespaces` by language."""

    file: str
    includes: tuple[tuple[str, int], ...] = ()
    namespaces: dict[str, str] = field(default_factory=dict)
    declarations: tuple[Declaration, ...] = ()
