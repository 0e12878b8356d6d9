"""Read the text of `.msg` and `.srv` files: declarations as they are spelled, nothing looked up.

    file   = lines; a service has `---` between request and response
    field  = TYPE NAME                  TYPE: a builtin, Name, package/Name, Header; and [] or [N]
    const  = TYPE NAME = VALUE          a string takes the rest of the line, '#' included

Rules: DecodeError names the type and the line. Names are plain ASCII letters, digits and `_`, so
they can become attributes and file names. What is read in a line does not depend on other lines but
for comments: those at the top belong to the message, others to the field that follows.
(Language of ROS 1, as genmsg of Noetic reads it; tabs separate too, and `[package/Type]:` lines are
skipped, as in C++ YARP.)
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, replace
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.limit import ROS_DECLARATIONS, ROS_TEXT

BUILTIN: Final = {
    **{name: name for name in ("bool", "string", "time", "duration", "float32", "float64")},
    **{f"{sign}int{bits}": f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
    "char": "uint8",
    "byte": "int8",
}

#: what `ast.literal_eval` raises for texts that are none
NO_LITERAL: Final = (
    *(ValueError, TypeError, SyntaxError, OverflowError, MemoryError, RecursionError),
)

_WORD: Final = r"[A-Za-z][A-Za-z0-9_]*+"
_NAME = re.compile(rf"{_WORD}/{_WORD}")
_TYPE = re.compile(rf"({_WORD}(?>(?:/{_WORD})?))(?>(\[(\d{{0,10}}+)\])?)")
_FIELD_NAME = re.compile(_WORD)


@dataclass(frozen=True, slots=True)
class FieldText:
    """`spelled` is the type as in the file, `base` without brackets and with its package. ROS 2
    alone has a limit for a list (`most`) and a `default`."""

    spelled: str
    base: str
    name: str
    is_list: bool = False
    length: int | None = None
    doc: str = ""
    most: int | None = None
    default: Any = None

    @property
    def builtin(self) -> str | None:
        """The name of the primitive, if it is one."""
        return self.base if self.base == "wstring" else BUILTIN.get(self.base)


@dataclass(frozen=True, slots=True)
class ConstantText:
    spelled: str
    name: str
    value: Any
    text: str
    doc: str = ""


@dataclass(frozen=True, slots=True)
class MessageText:
    """The contents of a `.msg` file, or of half a `.srv` file."""

    name: str
    text: str
    fields: tuple[FieldText, ...]
    constants: tuple[ConstantText, ...]
    doc: str = ""


def peer_type_name(name: str) -> str:
    """As `type_name`; but peers may have types without a package, as classes of C++ YARP do."""
    return name if _FIELD_NAME.fullmatch(name) else type_name(name)


def type_name(name: str) -> str:
    """`package/Type` of any way to write it (`package/msg/Type` too); DecodeError for others."""
    parts = name.split("/")
    if len(parts) == 3 and parts[1] in ("msg", "srv"):
        del parts[1]
    if name == "Header":
        return "std_msgs/Header"
    plain = "/".join(parts)
    if not _NAME.fullmatch(plain):
        raise DecodeError(f"{name[:80]!r} is no type of ROS: those are named package/Type")
    return plain


def parse_service(text: str, name: str) -> tuple[MessageText, MessageText]:
    """Request and response of a `.srv` file, named after the service as ROS does."""
    halves: list[list[str]] = [[], []]
    at = 0
    for line in text.split("\n"):
        if line.startswith("---"):
            at = 1
        else:
            halves[at].append(line)
    request, response = ("".join(f"{line}\n" for line in half) for half in halves)
    first = len(halves[0]) + 2
    return (
        parse_message(request, f"{name}Request"),
        parse_message(response, f"{name}Response", first),
    )


def parse_message(text: str, name: str, first_line: int = 1) -> MessageText:
    """Parse a `.msg` file; `name` is package/Type."""
    if len(text) > ROS_TEXT:
        raise DecodeError(f"{name}: a definition of more than {ROS_TEXT} characters")
    reader = _Reader(name[: name.rfind("/") + 1])
    for number, line in enumerate(text.split("\n"), first_line):
        try:
            reader.read(line)
        except ValueError as error:
            raise DecodeError(f"{name}, line {number}: {error}") from None
        if len(reader.fields) + len(reader.constants) > ROS_DECLARATIONS:
            raise DecodeError(f"{name}: more than {ROS_DECLARATIONS} fields and constants")
    reader.settle()
    fields, constants = tuple(reader.fields), tuple(reader.constants)
    seen: set[str] = set()
    for word in [item.name for item in fields] + [item.name for item in constants]:
        if word in seen:
            raise DecodeError(f"{name}: two declarations of {word!r}")
        seen.add(word)
    return MessageText(name, text, fields, constants, "\n".join(reader.top).strip())


class _Reader:
    """Takes the lines of a file one after the other."""

    def __init__(self, package: str) -> None:
        self.package = package  # with its slash
        self.fields: list[FieldText] = []
        self.constants: list[ConstantText] = []
        self.top: list[str] = []
        self.above: list[str] = []
        self.at_top = True
        self.remarked: list[Any] = []  # whose last declaration has a comment behind it
        self.below: list[str] = []  # how that goes on

    def read(self, line: str) -> None:
        code, _, remark = line.partition("#")
        code = code.strip()
        remark = lettered(remark.strip().lstrip("#").strip()) if "#" in line else ""
        if not code:
            self._remark(line, remark)
            return
        if code.startswith("["):
            return
        self.at_top = False
        self.settle()
        above, self.above = self.above, []
        if "=" in code:
            constant = _constant(line, code, above, remark)
            self.constants.append(constant)
            self.remarked = self.constants if remark and constant.spelled != "string" else []
        else:
            self.fields.append(self._field(code, "\n".join([*above, remark]).strip()))
            self.remarked = self.fields if remark else []

    def settle(self) -> None:
        """No comment of the last declaration follows any more."""
        if self.below:
            last = self.remarked[-1]
            self.remarked[-1] = replace(last, doc="\n".join([last.doc, *self.below]))
        self.remarked, self.below = [], []

    def _remark(self, line: str, remark: str) -> None:
        """A comment that stands alone, or an empty line, which ends one."""
        is_comment = line.lstrip().startswith("#")
        if is_comment and self.remarked and line[:1].isspace():  # it goes on below itself
            self.below.append(remark)
            return
        self.settle()
        if self.at_top:
            self.top.append(remark)
        elif is_comment:
            self.above.append(remark)
        else:
            self.above.clear()

    def _field(self, code: str, doc: str) -> FieldText:
        words = code.split()
        if len(words) != 2:
            raise ValueError(f"a type and a name are expected, not {code[:80]!r}")
        spelled, name = words
        found = _TYPE.fullmatch(spelled)
        if not found:
            raise ValueError(f"{spelled[:80]!r} is no type: int32, float64[], package/Type[3] are")
        if not _FIELD_NAME.fullmatch(name):
            raise ValueError(f"{name[:80]!r} is no name of a field: letters, digits and _")
        base = found[1]
        if spelled == "Header":  # of ROS; a list of them are those of the package
            base = "std_msgs/Header"
        elif base not in BUILTIN and "/" not in base:
            base = self.package + base
        length = int(found[3]) if found[3] else None
        return FieldText(spelled, base, name, found[2] is not None, length, doc)


def lettered(remark: str) -> str:
    """A comment as people read it: one that is not UTF-8 is in Latin-1, as in old packages."""
    raw = remark.encode("utf-8", "surrogateescape")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _constant(line: str, code: str, above: list[str], remark: str) -> ConstantText:
    spelled = code.split(None, 1)[0]
    if spelled not in BUILTIN or spelled in ("time", "duration"):
        raise ValueError(f"a constant is a number, a bool or a string, not {spelled[:80]!r}")
    declared, _, text = (line.lstrip() if spelled == "string" else code).partition("=")
    name, text = declared[len(spelled) :].strip(), text.strip()
    if not _FIELD_NAME.fullmatch(name):
        raise ValueError(f"{name[:80]!r} is no name of a constant: letters, digits and _")
    doc = "\n".join([*above, "" if spelled == "string" else remark]).strip()
    try:
        value = _value(BUILTIN[spelled], text)
    except NO_LITERAL:
        raise ValueError(f"{text[:80]!r} is no value of a {spelled}") from None
    return ConstantText(spelled, name, value, text, doc)


def _value(kind: str, text: str) -> Any:
    if kind == "string":
        return text
    if len(text) > 400:
        raise ValueError(text)
    if kind.startswith("float"):
        return float(text)
    if kind == "bool":
        return bool(ast.literal_eval(text))
    value = int(text)
    bits = int(kind.rpartition("int")[2])
    low = 0 if kind[0] == "u" else -(1 << bits - 1)
    if not low <= value < low + (1 << bits):
        raise ValueError(text)
    return value
