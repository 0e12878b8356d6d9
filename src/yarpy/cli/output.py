"""Values as people and scripts see them: lines of text and of JSON.

Rules: JSON keeps what it can: lists and dicts as they are, a vocab as `"[ok]"`, bytes as
`{"type": "blob", "base64": "..."}`, numbers that JSON lacks as the strings "nan", "inf", "-inf",
and sounds, clouds of points and arrays of Python as web pages get them.
(The JSON of web pages, `yarpy.data.json`, is another: it makes objects of lists that look so.)
One value per line, so that a stream of them can be read line by line.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from typing import Any

from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.log import readable


def jsonable(value: Any) -> Any:
    """`value` as something that `json` takes."""
    if isinstance(value, Vocab):
        return f"[{plain_text(value)}]"
    if isinstance(value, str):
        return value.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return float(value) if abs(value) < float("inf") else plain_text(float(value))
    if isinstance(value, bytes | bytearray | memoryview):
        import base64

        return {"type": "blob", "base64": base64.b64encode(value).decode("ascii")}
    if isinstance(value, dict):
        return {plain_text(key): jsonable(item) for key, item in value.items()}
    if isinstance(value, complex):
        return [jsonable(value.real), jsonable(value.imag)]
    if not isinstance(value, list) and (hasattr(value, "to_wire") or hasattr(value, "dtype")):
        from yarpy.data.json import to_json

        return json.loads(to_json(value))  # sounds, arrays of no type of YARP's ...
    return [jsonable(item) for item in value]


def print_json(value: Any) -> None:
    """One line of JSON on standard output, flushed."""
    print_line(json.dumps(jsonable(value), ensure_ascii=False))


def print_all_json(items: Iterable[Any]) -> None:
    """Each on a line of its own, as JSON."""
    for item in items:
        print_json(item)


def print_line(text: str) -> None:
    """One line on standard output, flushed: the reader of a pipe sees it at once."""
    out = sys.stdout
    if out is None:
        return  # it was closed by whoever started us: nobody wants to read
    if out.isatty():  # a terminal would obey what is in it; a program gets it as it is
        text = readable(text, keep="\n\t")
    out.write(text + "\n")
    out.flush()
