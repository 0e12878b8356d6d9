"""Answer the calls of Apache's protocols with a service.

Rules: a declared exception goes to the caller as it is, any other as a TApplicationException: a
YarpError refuses, a method that is not there is an unknown one. Arguments that are not there have
their defaults. A oneway call is not answered, whatever its client has called it.
"""

from __future__ import annotations

from collections.abc import Awaitable
from inspect import isawaitable
from typing import Any

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import encode
from yarpy.kits.thrift.apache.decode import READERS, fields
from yarpy.kits.thrift.apache.message import NOTHING, Answer, Call, faulty
from yarpy.kits.thrift.apache.protocol import (
    INTERNAL_ERROR,
    MISSING_RESULT,
    PROTOCOL_ERROR,
    REPLY,
    UNKNOWN_METHOD,
)
from yarpy.kits.thrift.method import Method
from yarpy.kits.thrift.structure import default_of
from yarpy.monitors.base import FAILURES


def answer(service: Any, call: Call) -> Any:
    """Return the Answer of a service to a call, or what is to be awaited for it."""
    method = service._methods.get(call.head.name)
    if method is None:
        call.request = lambda: b""
        text = f'no method "{call.head.name[:60]}" in {type(service).__name__}'
        return _said(call, None, UNKNOWN_METHOD, text)
    try:
        values = arguments(method, call)
    except DecodeError as error:
        return _said(call, method, PROTOCOL_ERROR, str(error))
    call.request = lambda: method.ask(*values)
    try:
        result = getattr(service, method.attribute)(*values)
        if isawaitable(result):
            return _finished(service, method, result, call)
    except FAILURES as error:
        return _failed(service, method, error, call)
    return _returned(service, method, result, call)


async def _finished(service: Any, method: Method, result: Awaitable[Any], call: Call) -> Answer:
    try:
        found = await result
    except FAILURES as error:
        return _failed(service, method, error, call)
    return _returned(service, method, found, call)


def arguments(method: Method, call: Call) -> list[Any]:
    """Return the arguments of a call. DecodeError."""
    reader = READERS[call.thrift](call.payload, call.at)
    kinds = dict(zip(method.numbers, (part.kind for part in method.parts), strict=True))
    found = fields(reader, kinds, method.name)
    first = len(method.parts) - len(method.defaults)
    values = []
    for at, (number, kind) in enumerate(kinds.items()):
        if number in found:
            values.append(found[number])
        else:
            make = method.defaults[at - first] if at >= first else default_of(kind)
            values.append(make())
    return values


def _returned(service: Any, method: Method, result: Any, call: Call) -> Answer:
    """The answer with a result."""
    if method.oneway:
        return NOTHING
    kind = method.result
    if kind is not None and result is None:
        text = f"{method.name} has no result: it returned None"
        return _said(call, method, MISSING_RESULT, text)
    found = [] if kind is None else [(0, kind, result, f"the result of {method.name}")]
    writer = encode.WRITERS[call.thrift]()
    try:
        encode.fields(writer, found)
    except Exception as error:
        return _failed(service, method, error, call)
    return Answer(REPLY, bytes(writer.out), lambda: method.answer(result))


def _failed(service: Any, method: Method, error: Exception | SystemExit, call: Call) -> Answer:
    """The answer that tells of an exception."""
    for number, kind in method.throws.items():
        if isinstance(error, kind) and not method.oneway:
            writer = encode.WRITERS[call.thrift]()
            try:
                encode.fields(writer, [(number, kind, error, kind.__name__)])
            except Exception as other:
                error = other
                break
            return Answer(REPLY, bytes(writer.out))
    kind_, reason = service._reason(error, call)
    text = f"{kind_}: {reason}" if kind_ else reason
    code = UNKNOWN_METHOD if isinstance(error, NotImplementedError) else INTERNAL_ERROR
    return _said(call, method, code, text)


def _said(call: Call, method: Method | None, kind: int, text: str) -> Answer:
    return NOTHING if method is not None and method.oneway else faulty(call.thrift, kind, text)
