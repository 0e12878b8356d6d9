"""The client of a service: its methods are calls of a port.

Rules: the bytes are made and read here, a port is handed in: whatever has `ask(question, timeout)`,
`tell(question)` and `close()`. Errors begin with the name of the server and the method. `[fail]`
becomes RemoteProtocolError, with the reason where the server is yarpy's.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct as Packing
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import LIST, STRING, VOCAB32, Buffer
from yarpy.errors import DecodeError, RemoteProtocolError, Timeout, YarpError
from yarpy.idl.rosmsg.code import Code
from yarpy.idl.thrift import reader
from yarpy.idl.thrift.extent import version_ending
from yarpy.idl.thrift.kind import BOOL, VOCAB, flat
from yarpy.idl.thrift.method import Method
from yarpy.idl.thrift.payload import FAILURE, VERSION, Payload
from yarpy.idl.thrift.writer import FAIL

_FAILED: Final = (LIST + VOCAB32, 1, FAIL)
_HEAD: Final = Packing("<iii").unpack_from
_VERSION: Final = Packing("<iihhhh")


class _Client:
    """What clients have beside the methods."""

    def __init__(self, port: Any, timeout: float | None) -> None:
        self._port = port
        self.timeout = timeout

    def _told(self, method: str, error: YarpError) -> YarpError:
        """An error of the port, with the name of the method."""
        if isinstance(error, Timeout):
            return Timeout(f"{method}: no answer within {self.timeout} s")
        return error if method in str(error) else type(error)(f"{method}: {error}")

    def __repr__(self) -> str:
        return f"<client of {type(self).__name__}>"


class _Sync(_Client):
    def _call(self, method: Method, data: bytes) -> Any:
        try:
            if method.oneway:
                self._port.tell(Payload(data))
                return None
            message = self._port.ask(Payload(data, method.ending), self.timeout)
            if message is None:
                return None
            answer = message.to_bytes()
            if is_failure(answer, method, message.spelling == "text"):
                why = reason(answer)
                if not why:
                    why = self._why()
                raise refused(method, why)
            return method.read_answer(answer)
        except YarpError as error:
            told = self._told(method.name, error)
            if told is error:
                raise
            raise told from error

    def _why(self) -> str:
        """What a server of yarpy says about the last failure."""
        message = self._port.ask(Bottle([FAILURE]), self.timeout)
        return "" if message is None else told(message.to_bytes())

    def remote_version(self) -> tuple[int, int, int, int] | None:
        """The version of the server's interface, and of its YARP: `(0, 3, 12, 0)`. None for those
        before 3.12, which do not tell."""
        message = self._port.ask(_version_question(), self.timeout)
        return None if message is None else version(message.to_bytes())

    def close(self) -> None:
        """End the connection."""
        self._port.close()


class _Async(_Client):
    async def _call(self, method: Method, data: bytes) -> Any:
        try:
            if method.oneway:
                await self._port.tell(Payload(data))
                return None
            message = await self._port.ask(Payload(data, method.ending), self.timeout)
            if message is None:
                return None
            answer = message.to_bytes()
            if is_failure(answer, method, message.spelling == "text"):
                why = reason(answer)
                if not why:
                    why = await self._why()
                raise refused(method, why)
            return method.read_answer(answer)
        except YarpError as error:
            told = self._told(method.name, error)
            if told is error:
                raise
            raise told from error

    async def _why(self) -> str:
        message = await self._port.ask(Bottle([FAILURE]), self.timeout)
        return "" if message is None else told(message.to_bytes())

    async def remote_version(self) -> tuple[int, int, int, int] | None:
        """As that of the other client."""
        message = await self._port.ask(_version_question(), self.timeout)
        return None if message is None else version(message.to_bytes())

    async def close(self) -> None:
        """End the connection."""
        await self._port.close()

    async def __aenter__(self) -> Any:
        await self._port.open()
        return self

    async def __aexit__(self, *error: object) -> None:
        await self.close()


def client_class(service: type[Any], waits: bool = False) -> Callable[[Any, Any], Any]:
    """The class of the clients of a service. `waits`: in an event loop."""
    kept = f"_client{waits:d}_"
    found: Callable[[Any, Any], Any] | None = service.__dict__.get(kept)
    if found is None:
        found = _made(service, waits)
        setattr(service, kept, found)
    return found


def _made(service: type[Any], waits: bool) -> Callable[[Any, Any], Any]:
    base = _Async if waits else _Sync
    methods = {each.attribute: _call(each) for each in service._methods.values()}
    return type(service.__name__, (base, service), methods)


def _call(method: Method) -> Any:
    """A function with the arguments of a method, which calls it."""
    code = Code()
    arguments = ["self"]
    names = [*method.signature.parameters][1:]
    first = len(names) - len(method.defaults)
    code.globals.update(_method=method, _nothing=_NOTHING, _ask=method.ask)
    for at, name in enumerate(names):
        if at < first:
            arguments.append(name)
            continue
        arguments.append(f"{name}=_nothing")
        code.line(f"if {name} is _nothing: {name} = {code.name(method.defaults[at - first])}()")
    code.line(f"return self._call(_method, _ask({', '.join(names)}))")
    made = code.compiled(method.attribute, ", ".join(arguments))
    made.__doc__ = method.doc
    return made


_NOTHING: Final = object()


def is_failure(answer: Buffer, method: Method, text: bool) -> bool:
    """Whether an answer says that the call failed: `[fail]`, which a false result is not, for that
    comes in a list of mixed elements. (As text both are the same, and a result wins.)"""
    if len(answer) < 12:
        return False
    head = _HEAD(answer)
    result = method.result
    may_be = result is BOOL or result is VOCAB
    if head == _FAILED:
        return not (text and may_be)
    if len(answer) < 16 or head[0] != LIST or head[2] != VOCAB32:
        return False
    if _HEAD(answer, 4)[2] != FAIL:
        return False
    if head[1] == 1:
        return not may_be
    return head[1] == 2 and (result is None or flat(result) != 2) and bool(reason(answer))


def reason(answer: Buffer) -> str:
    """What stands beside `[fail]`."""
    if len(answer) >= 24 and _HEAD(answer)[1] == 2 and _HEAD(answer, 16)[0] == STRING:
        return str(bytes(answer[24:]), "utf-8", "replace")
    return ""


def told(answer: Buffer) -> str:
    """The reason that was asked for; "" from servers that know no such question."""
    try:
        found = Bottle.from_bytes(reader.spread(answer))
    except DecodeError:
        return ""
    return str(found[0]) if len(found) == 1 and type(found[0]) is str else ""


def refused(method: Method, why: str) -> RemoteProtocolError:
    return RemoteProtocolError(
        f"the server refuses {method.name}" + (f": {why}" if why else "; its log may say why")
    )


def _version_question() -> Payload:
    return Payload(Bottle([VERSION]).to_bytes(), version_ending)


def version(answer: Buffer) -> tuple[int, int, int, int] | None:
    """The versions in an answer; None if it says none."""
    if len(answer) == _VERSION.size and _VERSION.unpack(answer)[:2] == (LIST, 1):
        return _VERSION.unpack(answer)[2:]
    try:
        found = Bottle.from_bytes(answer)
    except DecodeError:
        return None
    if len(found) == 4 and all(isinstance(each, int) for each in found):
        service, major, minor, patch = map(int, found)
        return service, major, minor, patch
    return None
