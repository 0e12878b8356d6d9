"""Read the text of `.msg` and `.srv` files of ROS 2.

    field = TYPE NAME [DEFAULT]    TYPE: builtin, Name, package/Name, string<=N; and [], [N], [<=N]
    const = TYPE NAME = VALUE      strings stand in quotes, or take the rest of the line

Rules: as in `ros/message/parse.py`, whose results these are; `#` begins a comment outside of
quotes. What counts in the type hash keeps its spelling. (Language: rosidl, and REP 2016 for what it
means.)
"""

from __future__ import annotations

import ast
import re
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.limit import ROS_DECLARATIONS, ROS_TEXT
from yarpy.peers.ros.message.parse import NO_LITERAL, ConstantText, FieldText, MessageText, lettered

#: the number of each type in a type description (REP 2016), and what carries it here
BUILTIN: Final = {
    "int8": (2, "int8"),
    "uint8": (3, "uint8"),
    "int16": (4, "int16"),
    "uint16": (5, "uint16"),
    "int32": (6, "int32"),
    "uint32": (7, "uint32"),
    "int64": (8, "int64"),
    "uint64": (9, "uint64"),
    "float32": (10, "float32"),
    "float64": (11, "float64"),
    "char": (3, "uint8"),
    "bool": (15, "bool"),
    "byte": (16, "uint8"),
    "string": (17, "string"),
    "wstring": (18, "wstring"),
}
_TEXTS: Final = ("string", "wstring")

_WORD: Final = r"[A-Za-z][A-Za-z0-9_]*+"
_LINE: Final = re.compile(
    rf"(?P<base>{_WORD}(?>(?:/{_WORD}){{0,2}}))(?>(?:<=(?P<chars>\d{{1,10}}+))?)"
    r"(?>(?P<list>\[(?>(?:(?>(?P<bound><=)?)(?P<length>\d{1,10}+))?)\])?)"
    rf"[ \t]++(?P<name>{_WORD})(?P<rest>.*)",
    re.DOTALL,
)
_SEPARATOR: Final = "---"


def parse_service(text: str, name: str) -> tuple[MessageText, MessageText]:
    """Request and response of a `.srv` file, named as ROS 2 does."""
    halves: list[list[str]] = [[], []]
    at = 0
    for line in text.split("\n"):
        if line.startswith(_SEPARATOR) and not at:
            at = 1
        else:
            halves[at].append(line)
    request, response = ("".join(f"{line}\n" for line in half) for half in halves)
    return (
        parse_message(request, f"{name}_Request"),
        parse_message(response, f"{name}_Response", len(halves[0]) + 2),
    )


def parse_message(text: str, name: str, first_line: int = 1) -> MessageText:
    """Parse a `.msg` file; `name` is package/Type. Raises DecodeError, which names the line."""
    if len(text) > ROS_TEXT:
        raise DecodeError(f"{name}: a definition of more than {ROS_TEXT} characters")
    package = name[: name.find("/") + 1]
    fields: list[FieldText] = []
    constants: list[ConstantText] = []
    top: list[str] = []
    above: list[str] = []
    seen: set[str] = set()
    for number, line in enumerate(text.split("\n"), first_line):
        code, remark = _split(line)
        if not code:
            (above if seen else top).append(remark)
            if not remark:
                above.clear()
            continue
        doc = "\n".join([*above, remark]).strip()
        above.clear()
        try:
            item = _declaration(code, package, doc)
        except ValueError as error:
            raise DecodeError(f"{name}, line {number}: {error}") from None
        if item.name in seen:
            raise DecodeError(f"{name}, line {number}: two declarations of {item.name!r}")
        seen.add(item.name)
        if len(seen) > ROS_DECLARATIONS:
            raise DecodeError(f"{name}: more than {ROS_DECLARATIONS} fields and constants")
        if isinstance(item, FieldText):
            fields.append(item)
        else:
            constants.append(item)
    return MessageText(name, text, tuple(fields), tuple(constants), "\n".join(top).strip())


def _split(line: str) -> tuple[str, str]:
    """The declaration in a line, and the comment behind it."""
    quote = ""
    for at, c in enumerate(line):
        if quote:
            quote = "" if c == quote else quote
        elif c in "\"'":
            quote = c
        elif c == "#":
            return line[:at].strip(), lettered(line[at:].lstrip("#").strip())
    code, _, remark = line.partition("#") if quote else (line, "", "")
    return code.strip(), lettered(remark.strip())


def _declaration(code: str, package: str, doc: str) -> FieldText | ConstantText:
    found = _LINE.fullmatch(code)
    if found is None:
        raise ValueError(f"a type and a name are expected, not {code[:80]!r}")
    base, name, rest = found["base"], found["name"], found["rest"].strip()
    if found["chars"] is not None and base not in _TEXTS:
        raise ValueError(f"{base}<={found['chars']}: only strings are limited so")
    if rest and found["rest"][0] not in " \t=":
        raise ValueError(f"{code[:80]!r}: letters, digits and _ make the name of a field")
    builtin = BUILTIN.get(base)
    spelled = code[: found.end("list") if found["list"] else found.start("name")].strip()
    if rest.startswith("="):
        if builtin is None or found["list"]:
            raise ValueError(f"a constant is a number, a bool or a string, not {spelled[:80]!r}")
        text = rest[1:].strip()
        kind = builtin[1].removeprefix("w")
        return ConstantText(kind, name, _value(kind, text), text, doc)
    if builtin is not None:
        base = builtin[1]
    elif "/" not in base:
        base = package + base
    else:
        parts = base.split("/")
        if len(parts) == 3 and parts[1] not in ("msg", "action"):
            raise ValueError(f"{base[:80]!r} is no message")
        if len(parts) == 2 or parts[1] == "msg":
            base = f"{parts[0]}/{parts[-1]}"
    length = int(found["length"]) if found["length"] is not None else None
    if length == 0 and not found["bound"]:
        raise ValueError(f"{spelled[:80]!r}: an array of no elements")
    fixed, most = (None, length) if found["bound"] else (length, None)
    default = _default(builtin, bool(found["list"]), fixed, rest) if rest else None
    return FieldText(spelled, base, name, bool(found["list"]), fixed, doc, most, default)


def _default(builtin: tuple[int, str] | None, is_list: bool, fixed: int | None, text: str) -> Any:
    if builtin is None:
        raise ValueError(f"{text[:80]!r}: only numbers, bools and strings have a default")
    if not is_list:
        return _value(builtin[1], text)
    if len(text) > 1 << 14:
        raise ValueError("a default of so many elements")
    try:
        items = ast.literal_eval(re.sub(r"\b(true|false)\b", lambda m: m[1].title(), text))
    except NO_LITERAL:
        raise ValueError(f"{text[:80]!r} is no list of {builtin[1]}") from None
    if not isinstance(items, list) or (fixed is not None and len(items) != fixed):
        raise ValueError(f"{text[:80]!r} is no list of {builtin[1]} of that length")
    return tuple(
        item if isinstance(item, str) and builtin[1] in _TEXTS else _value(builtin[1], str(item))
        for item in items
    )


def _value(kind: str, text: str) -> Any:
    if kind in _TEXTS:
        quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
        return text[1:-1] if quoted else text
    wrong = ValueError(f"{text[:80]!r} is no value of a {kind}")
    if len(text) > 400:
        raise wrong
    try:
        if kind.startswith("float"):
            return float(text)
        if kind == "bool":
            return {"true": True, "1": True, "false": False, "0": False}[text.lower()]
        value = int(text, 0)
    except (ValueError, KeyError):
        raise wrong from None
    bits = int(kind.rpartition("int")[2])
    low = 0 if kind[0] == "u" else -(1 << bits - 1)
    if not low <= value < low + (1 << bits):
        raise wrong
    return value
