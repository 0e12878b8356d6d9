"""XML-RPC: calls and answers as messages, and messages as calls and answers.

    method(1, "two words", [2.5])        method 1 "two words" (2.5)
    {"a": 1, "b": "x"}                   (dict (a 1) (b x))
    ["dict", 2]  within a call           (list dict 2)
    "[send]"                             the vocab send

Rules: writing, every message gives valid XML-RPC, with the same bytes as C++ YARP where that writes
valid XML-RPC: a list of pairs is a struct, `list` and `dict` in front of a list say what it is.
What it leaves out or spoils has a form of its own here: long integers `<i8>`, truth `<boolean>`,
blobs `<base64>`, empty lists, numbers with more than six decimals. A Sound, a PointCloud and arrays
that YARP has no type for are blobs; what a description says for Python is left out. Reading is the
work of the standard library, behind defusedxml: no document types, no entities. Whatever is wrong
is a DecodeError.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.python.description import KEY
from yarpy.data.text import plain_text
from yarpy.data.value import MAX_DEPTH, Vocab, fits
from yarpy.errors import DecodeError

_HEAD: Final = '<?xml version="1.0"?>\r\n'
_FORBIDDEN: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def encode_call(message: object) -> bytes:
    """The call that a message stands for: its first element is the method, the rest are
    arguments. A single argument that is a list holds the arguments; arguments that are all pairs
    are one struct."""
    items = _elements(message)
    name = plain_text(items[0]) if items else ""
    arguments = items[1:]
    if len(arguments) == 1 and isinstance(arguments[0], (list, tuple)):
        arguments = arguments[0]
    if _is_struct(arguments):
        arguments = [arguments]
    elif _word(arguments) == "list":
        arguments = arguments[1:]
    params = "".join(f"<param>{_value(argument)}</param>" for argument in arguments)
    body = f"<params>{params}</params>" if params else ""
    return _encode(f"<methodCall><methodName>{_escape(name)}</methodName>\r\n{body}</methodCall>")


def encode_answer(value: object, terse: bool = False) -> bytes:
    """The answer with one value. A list of one element is that element, an empty one an empty
    string. `terse`: empty lists inside are left out, as nodes expect it of YARP."""
    if isinstance(value, Plain):
        from xmlrpc.client import dumps

        return dumps(([*value],), methodresponse=True).encode()
    text = _top(value, terse)
    return _encode(
        f"<methodResponse><params><param>\r\n\t{text}\r\n</param></params></methodResponse>"
    )


def encode_nothing() -> bytes:
    """The answer that only says that a call has come."""
    return _encode("<methodResponse><params></params></methodResponse>")


def encode_fault(code: int, text: str) -> bytes:
    """The answer to a call that cannot be understood."""
    fault = _value({"faultCode": code, "faultString": text})
    return _encode(f"<methodResponse><fault>{fault}</fault></methodResponse>")


def decode_call(data: bytes | memoryview) -> Bottle:
    """A call as a message: the method's name as text gives it, then the arguments."""
    arguments, name = _parse(data)
    if name is None:
        raise DecodeError("this is XML-RPC, but no call of a method")
    return Bottle([*Bottle.from_text(name), *_some(arguments)])


def decode_answer(data: bytes | memoryview) -> Bottle | None:
    """An answer as a message; None if it has no value. A fault is `dict (faultCode 1)
    (faultString ...)`."""
    from xmlrpc.client import Fault

    try:
        values, _ = _parse(data)
    except Fault as fault:
        values = ({"faultCode": fault.faultCode, "faultString": fault.faultString},)
    if not values or values[0] is None:
        return None
    if isinstance(values[0], list):
        return Bottle(_some(values[0]))
    value = _read(values[0], 1)
    return value if isinstance(value, Bottle) else Bottle([value])


class Last(Bottle):
    """An answer behind which the connection ends."""

    is_last = True


class Plain(Last):
    """An answer that is spelled as it is: lists are arrays, dicts structs, nothing is left out."""


def encode_plain_call(name: str, arguments: Sequence[Any]) -> bytes:
    """A call with just these arguments. TypeError or OverflowError for what XML-RPC cannot say."""
    from xmlrpc.client import dumps

    return dumps(tuple(arguments), name).encode()


def decode_plain_answer(data: bytes | memoryview) -> Any:
    """The value of an answer, as the standard library reads it; DecodeError for faults too."""
    from xmlrpc.client import Fault

    try:
        values, _ = _parse(data)
    except Fault as fault:
        raise DecodeError(f"a fault: {str(fault.faultString)[:200]}") from fault
    return values[0] if values else None


# -------------------------------------------------------------------------------------- writing


def _encode(text: str) -> bytes:
    return (_HEAD + text + "\r\n").encode()


def _elements(message: object) -> Sequence[Any]:
    if isinstance(message, (list, tuple)):
        return message
    if isinstance(message, Mapping):
        return ["dict", *(Bottle(pair) for pair in message.items())]
    if isinstance(message, (str, int, float, bytes)):
        return [message]
    found = codec.listed(b"".join(map(bytes, codec.encode(message))))
    last = found[-1] if found else None
    if isinstance(last, list) and last[:1] == [KEY]:
        del found[-1]
    return found


def _top(value: object, terse: bool) -> str:
    if isinstance(value, Mapping):
        return _struct(value.items(), 0, terse)
    items = _elements(value)
    if not items:
        return "<value></value>"
    return _value(items[0], 0, terse) if len(items) == 1 else _list(items, 0, terse)


def _value(value: Any, depth: int = 0, terse: bool = False) -> str:
    if isinstance(value, bool):
        return f"<value><boolean>{value:d}</boolean></value>"
    if isinstance(value, int):
        kind = "i4" if fits(value, 32) else "i8"
        return f"<value><{kind}>{int(value)}</{kind}></value>"
    if isinstance(value, float):
        return f"<value><double>{_decimal(value)}</double></value>"
    if isinstance(value, Vocab):
        return f"<value>[{_escape(str(value))}]</value>"
    if isinstance(value, str):
        return f"<value>{_escape(value)}</value>"
    if isinstance(value, (bytes, bytearray, memoryview)):
        from base64 import b64encode

        return f"<value><base64>{b64encode(value).decode()}</base64></value>"
    if depth >= MAX_DEPTH:
        raise DecodeError(f"a message nested more than {MAX_DEPTH} deep")
    if isinstance(value, Mapping):
        return _struct(value.items(), depth, terse)
    return _list(_elements(value), depth, terse)


def _list(items: Sequence[Any], depth: int, terse: bool) -> str:
    word = _word(items)
    if word == "dict":
        pairs = [item for item in items[1:] if isinstance(item, (list, tuple)) and item]
        return _struct(
            ((item[0], item[1] if len(item) > 1 else "") for item in pairs), depth, terse
        )
    if word == "list":
        items = items[1:]
    elif _is_struct(items):
        return _struct(((item[0], item[1]) for item in items), depth, terse)
    inner = (
        _value(item, depth + 1, terse)
        for item in items
        if not (terse and isinstance(item, (list, tuple)) and not item)
    )
    return f"<value><array><data>{''.join(inner)}</data></array></value>"


def _word(items: Sequence[Any]) -> str:
    return items[0] if items and type(items[0]) is str else ""


def _is_struct(items: Sequence[Any]) -> bool:
    """Return whether C++ takes a list for a struct."""
    if _word(items) == "dict":
        return True
    return bool(items) and all(isinstance(item, (list, tuple)) and len(item) == 2 for item in items)


def _struct(pairs: Any, depth: int, terse: bool) -> str:
    members = {plain_text(key): _value(value, depth + 1, terse) for key, value in pairs}
    inner = "".join(
        f"<member><name>{_escape(key)}</name>{text}</member>" for key, text in members.items()
    )
    return f"<value><struct>{inner}</struct></value>"


def _decimal(value: float) -> str:
    """As C++ prints it, if that is the same number."""
    text = f"{value:f}"
    return text if float(text) == value or value != value else repr(float(value))


def _escape(text: str) -> str:
    text = _FORBIDDEN.sub("\ufffd", text)
    for letter, name in (("&", "amp"), ("<", "lt"), (">", "gt"), ("'", "apos"), ('"', "quot")):
        text = text.replace(letter, f"&{name};")
    return text


# -------------------------------------------------------------------------------------- reading


def _parse(data: bytes | memoryview) -> tuple[tuple[Any, ...], str | None]:
    """Arguments or values, and the name of the method if it is a call. Raises Fault."""
    from xmlrpc.client import Fault, Unmarshaller

    from defusedxml.xmlrpc import DefusedExpatParser

    target = Unmarshaller(use_builtin_types=True)
    try:
        parser = DefusedExpatParser(target, forbid_dtd=True)
        parser.feed(bytes(data))
        parser.close()
        return target.close(), target.getmethodname()
    except Fault:
        raise
    except Exception as error:  # expat's, defusedxml's, and errors from broken values
        text = str(error) or type(error).__name__
        raise DecodeError(f"this is not XML-RPC: {text}") from error


def _some(items: Sequence[Any]) -> Iterator[Any]:
    """Values of arguments; nothing (`<nil/>`) is left out, as no message can hold it."""
    return (_read(item, 1) for item in items if item is not None)


def _read(value: Any, depth: int) -> Any:
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (bool, float, bytes)):
        return value
    if isinstance(value, int):
        if not fits(value, 64):
            raise DecodeError("an integer of more than 64 bits")
        return value
    if depth >= MAX_DEPTH:
        raise DecodeError(f"XML-RPC nested more than {MAX_DEPTH} deep")
    if isinstance(value, (list, tuple)):
        items = [_read(item, depth + 1) for item in value if item is not None]
        front = ["list"] if items and type(items[0]) is str and items[0] in ("list", "dict") else []
        return Bottle(front + items)
    if isinstance(value, dict):
        pairs = sorted(value.items())
        return Bottle(
            ["dict"]
            + [
                Bottle([key] if item is None else [key, _read(item, depth + 1)])
                for key, item in pairs
            ]
        )
    if isinstance(value, datetime):
        return value.isoformat()
    raise DecodeError(f"a {type(value).__name__} cannot be part of a message")


def _text(text: str) -> Any:
    """A string; in brackets it is a vocab, or whatever Bottle text makes of it."""
    if text.startswith("["):
        found = Bottle.from_text(text)
        if len(found) == 1:
            return found[0]
    return text
