"""The pages that are made from the code: docs/api.md, every public name, and docs/errors.md.

    python tests/support/reference.py      writes them; tests/test_reference.py compares

Rules: what is said there stands in the code, in docstrings and messages. A line here is about form.
"""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, Final

import yarpy
from yarpy import aio, clock
from yarpy.kits import thrift, wrap

ROOT: Final = Path(__file__).parents[2]
SOURCE: Final = ROOT / "src" / "yarpy"
API: Final = ROOT / "docs" / "api.md"
ERRORS: Final = ROOT / "docs" / "errors.md"

#: groups of names, in the order of the page
GROUPS: Final = {
    "Ports": ("Port", "BufferedPort", "RpcServer", "RpcClient", "Message", "Page"),
    "Connections": ("Connection", "ConnectionEvent", "DeadlineEvent", "Qos"),
    "Counters": ("PortStats", "ConnectionStats", "RemoteStats", "PastStats", "Totals"),
    "The network": (
        *("connect", "disconnect", "is_connected", "exists", "query", "ping", "wait_for", "admin"),
        *("Contact", "NameServer", "LocalNames", "NameClient", "YarpNameClient"),
    ),
    "Data": (
        *("Bottle", "Property", "Vocab", "Int8", "Int16", "Int64", "Float32", "Stamp", "Vector"),
        *("Matrix", "Image", "FlexImage", "Sound", "PointCloud", "to_json", "from_json"),
    ),
    "Programs": ("Module", "ResourceFinder", "realtime"),
}
ROOMS: Final = {
    "yarpy.aio": (aio, "The same ports in an event loop: [ports.md](ports.md#in-an-event-loop)."),
    "yarpy.clock": (
        clock,
        "The time of a simulation: [modules.md](modules.md#the-time-of-a-simulation).",
    ),
    "yarpy.wrap": (wrap, "Decorators: [wrap.md](wrap.md)."),
    "yarpy.kits.thrift": (thrift, "Interfaces of Thrift: [thrift.md](thrift.md)."),
}
ELSEWHERE: Final = (
    "`yarpy.idl.load` reads types of other systems ([thrift.md](thrift.md), "
    "[ros-messages.md](ros-messages.md)), `yarpy.devices` has robots, cameras and sensors "
    "([devices.md](devices.md)), `yarpy.record` reads and writes recordings, `yarpy.ros` "
    "([ros.md](ros.md)), `yarpy.ros2` ([ros2.md](ros2.md)) and `yarpy.zenoh` "
    "([zenoh.md](zenoh.md)) are for those systems."
)


def api() -> str:
    """The page of the public API."""
    lines = [
        "# The API",
        "",
        "Every public name, made from the code (`python tests/support/reference.py`). What raises "
        "which error is in the docstrings: `help(yarpy.Port.connect)`.",
    ]
    seen: dict[int, str] = {}
    for title, names in GROUPS.items():
        lines += ["", f"## {title}", "", "| name | what it is |", "|---|---|"]
        for name in names:
            lines.append(_row(name, getattr(yarpy, name)))
        for name in names:
            lines += _members(name, getattr(yarpy, name), seen)
    lines += ["", "## Errors", "", "See [errors.md](errors.md) for their messages.", ""]
    lines += ["| name | what it is |", "|---|---|"]
    lines += [_row(name, getattr(yarpy, name)) for name in error_names()]
    for title, (module, said) in ROOMS.items():
        lines += ["", f"## {title}", "", said, "", "| name | what it is |", "|---|---|"]
        for name in sorted(module.__all__, key=lambda one: (one[0].islower(), one)):
            found = getattr(module, name)
            if inspect.isroutine(found) or inspect.isclass(found):
                lines.append(_row(name, found))
    lines += ["", "## Elsewhere", "", ELSEWHERE]
    return "\n".join(lines) + "\n"


def error_names() -> list[str]:
    """The names of the errors, as they stand in the tree."""
    return [
        name
        for name, found in vars(sys.modules["yarpy.errors"]).items()
        if inspect.isclass(found) and issubclass(found, yarpy.YarpError)
    ]


@cache
def errors() -> str:
    """The page of all errors: what each means, what mends it, and every message."""
    lines = [
        "# Errors",
        "",
        "Every error that yarpy raises is a `yarpy.YarpError`; most are an error of Python's own, "
        "too. A message says what happened and what to do next: these are all of them, made from "
        "the code (`python tests/support/reference.py`), where `...` stands for what is only known "
        "when it happens. At the command line they stand behind `error:`.",
        "",
        "```text",
        *inspect.cleandoc(sys.modules["yarpy.errors"].__doc__ or "")
        .partition("\n\n")[2]
        .partition("\n\nRules")[0]
        .splitlines(),
        "```",
    ]
    said = _messages()
    for name in error_names():
        words = inspect.cleandoc(getattr(yarpy, name).__doc__ or "").split("\n\n")
        lines += ["", f"## {name}", ""]
        lines.append(" ".join(words[0].split()))
        if len(words) > 1:
            lines += ["", f"**What mends it.** {' '.join(words[1].split())}"]
        if said.get(name):
            lines += ["", *(f"- {_code(text)}" for text in said[name])]
    return "\n".join(lines) + "\n"


def _code(text: str) -> str:
    """A text as it is, in one line."""
    fence = "``" if "`" in text else "`"
    pad = " " if fence == "``" else ""
    return f"{fence}{pad}{text}{pad}{fence}"


def _messages() -> dict[str, list[str]]:
    """What stands in the code, by the name of the error."""
    names = {*error_names()}
    made = re.compile(rf"\b({'|'.join(names)})\(")
    found: dict[str, set[str]] = {}
    for path in SOURCE.rglob("*.py"):
        text = path.read_text("utf-8")
        for node in ast.walk(ast.parse(text)) if made.search(text) else ():
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.args:
                name, said = node.func.id, _template(node.args[0])
                if name in names and len(re.findall(r"\w{2,}", said)) > 1:
                    found.setdefault(name, set()).add(said)
    return {
        name: sorted(texts, key=lambda text: (_sort_key(text), text))
        for name, texts in found.items()
    }


def _sort_key(text: str) -> tuple[str, str]:
    return re.sub(r"[^a-z ]", "", text.lower()).strip(), text


def _template(node: ast.expr) -> str:
    """The text that an expression makes, with `...` for what is put into it; "" for another."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        text = node.value
    elif isinstance(node, ast.JoinedStr):
        pieces = [
            part.value if isinstance(part, ast.Constant) and isinstance(part.value, str) else "..."
            for part in node.values
        ]
        text = "".join(pieces)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        left, right = _template(node.left), _template(node.right)
        text = (left or "...") + (right or "...") if left or right else ""
    else:
        text = ""
    return " ".join(re.sub(r"(\.\.\.)+", "...", text).split())


def _row(name: str, found: Any) -> str:
    shown = f"`{name}{_signature(found)}`" if inspect.isroutine(found) else f"`{name}`"
    return f"| {shown.replace('|', chr(92) + '|')} | {_first_sentence(found)} |"


def _members(name: str, found: Any, seen: dict[int, str]) -> list[str]:
    """The table of what a class that this project has written has; what it shares with one that
    came before is left out."""
    if not inspect.isclass(found):
        return []
    shared: dict[str, list[str]] = {}
    rows = []
    members = _all(found)
    if "__init__" in members and not dataclasses.is_dataclass(found):
        rows.append(f"| `{name}{_signature(found)}` | |")
    if dataclasses.is_dataclass(found):
        rows += [f"| `.{one.name}: {_name(one.type)}` | |" for one in dataclasses.fields(found)]
    for member, value in sorted(members.items()):
        if member.startswith("_") or not _own(value):
            continue
        if id(value) in seen:
            shared.setdefault(seen[id(value)], []).append(member)
            continue
        seen[id(value)] = name
        if isinstance(value, property):
            rows.append(f"| `.{member}{_returned(value)}` | {_first_sentence(value)} |")
        else:
            function = getattr(value, "__func__", value)
            shown = f".{member}{_signature(function, bound=not isinstance(value, staticmethod))}"
            rows.append(f"| `{shown}` | {_first_sentence(function)} |")
    for other, same in shared.items():
        few = ", ".join(f"`.{one}`" for one in same) if len(same) < 4 else "..."
        rows.append(f"| {few} | as of `{other}` |")
    rows = [_escaped(row) for row in rows]
    return ["", f"### {name}", "", "| | |", "|---|---|", *rows] if rows else []


def _escaped(row: str) -> str:
    """A row in which bars within code are no borders."""
    return re.sub(r"`[^`]*`", lambda code: code[0].replace("|", r"\|"), row)


def _all(cls: type[Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        if base.__module__.startswith("yarpy"):
            found.update(vars(base))
    return found


def _own(value: Any) -> bool:
    """Whether a member has words of its own, and is a method or a property."""
    function = getattr(value, "fget", None) or getattr(value, "__func__", value)
    return bool(getattr(function, "__doc__", None)) and (
        isinstance(value, property | classmethod | staticmethod) or inspect.isfunction(value)
    )


def _signature(found: Any, bound: bool = False) -> str:
    """The parameters, without `self`, and what is returned, as they are written."""
    try:
        signature = inspect.signature(found)
    except (TypeError, ValueError):
        return "(...)"
    parameters = [*signature.parameters.values()]
    if bound or inspect.isclass(found):
        parameters = [one for one in parameters if one.name not in ("self", "cls")]
    shown = ", ".join(_parameter(one) for one in _starred(parameters))
    returned = signature.return_annotation
    tail = "" if returned in (signature.empty, "None", None) else f" -> {_name(returned)}"
    return f"({shown}){'' if inspect.isclass(found) else tail}"


def _starred(parameters: list[inspect.Parameter]) -> Iterator[inspect.Parameter | str]:
    marked = any(one.kind is one.VAR_POSITIONAL for one in parameters)
    for one in parameters:
        if one.kind is one.KEYWORD_ONLY and not marked:
            marked = True
            yield "*"
        yield one


def _parameter(one: inspect.Parameter | str) -> str:
    if isinstance(one, str):
        return one
    if one.kind is one.VAR_POSITIONAL:
        return f"*{one.name}"
    if one.kind is one.VAR_KEYWORD:
        return f"**{one.name}"
    default = "" if one.default is one.empty else f"={_default(one.default)}"
    return f"{one.name}{default}"


def _default(value: Any) -> str:
    said = repr(value)
    return "..." if " at 0x" in said or len(said) > 30 else said


def _returned(value: property) -> str:
    returned = inspect.signature(value.fget or (lambda: None)).return_annotation
    return "" if returned is inspect.Signature.empty else f": {_name(returned)}"


def _name(annotation: Any) -> str:
    said = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "")
    return str(said or annotation).replace("typing.", "")


def _first_sentence(found: Any) -> str:
    text = " ".join(inspect.cleandoc(found.__doc__ or "").partition("\n\n")[0].split())
    end = re.search(r"(?<!\.)[.:;](?= [A-Z]|$)", text)
    text = text[: end.start()] if end else text
    return text.replace("|", r"\|").removesuffix(":")


if __name__ == "__main__":
    API.write_text(api())
    ERRORS.write_text(errors())
