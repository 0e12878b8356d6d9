"""The client of a service: its methods are calls of a port.

Rules: the bytes are made and read here, a port is handed in: whatever has `ask(question, timeout)`,
`tell(question)` and `close()`. Errors begin with the name of the server and the method. `[fail]`
becomes RemoteProtocolError, with the reason where the server is yarpy's, and RemoteError where its
method has raised an exception. A server of YARP 4.0,
which spells floats otherwise, is known by its version.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from struct import Struct as Packing
from typing import Any, Final, TypeAlias

from yarpy.data.bottle import Bottle
from yarpy.data.failure import marked
from yarpy.data.generated import Code
from yarpy.data.value import LIST, STRING, VOCAB32, Buffer
from yarpy.errors import (
    DecodeError,
    LinkClosed,
    RemoteError,
    RemoteProtocolError,
    Timeout,
    YarpError,
)
from yarpy.kits.thrift.apache import client as apache
from yarpy.kits.thrift.kind import BOOL, VOCAB, flat
from yarpy.kits.thrift.method import Method
from yarpy.kits.thrift.payload import FAILURE, VERSION, Payload
from yarpy.kits.thrift.wire.cursor import spread
from yarpy.kits.thrift.wire.extent import is_version, version_ending
from yarpy.kits.thrift.wire.writer import FAIL

_FAILED: Final = (LIST + VOCAB32, 1, FAIL)
_HEAD: Final = Packing("<iii").unpack_from
_VERSION: Final = Packing("<iihhhh")

_Work: TypeAlias = Generator[tuple[Any, bool], Any, Any]


class _Client:
    """The base of clients. The work of a method is written once, as a generator that yields a
    payload and whether it is a question, and is given the answer."""

    def __init__(self, port: Any, timeout: float | None) -> None:
        self._port = port
        self.timeout = timeout
        self._yarp4: bool | None = None  # whether the server spells floats as YARP 4.0; None: ask

    def _work(self, method: Method, values: tuple[Any, ...]) -> _Work:
        """A call of a method. TypeError, OverflowError for what cannot be sent."""
        data: Buffer = method.ask(*values)
        ending = method.ending
        try:
            if method.minds_version and (yield from self._speaks_yarp4()):
                data, ending = method.yarp4_ask(values), method.yarp4_ending
            if method.oneway:
                yield Payload(data), False
                return None
            message = yield Payload(data, ending), True
            if message is None:
                return None
            answer = message.to_bytes()
            if is_failure(answer, method, message.spelling == "text"):
                yield from self._refused(method, answer)
            return method.read_answer(answer)
        except YarpError as error:
            said = self._told(method.name, error)
            if said is error:
                raise
            raise said from error

    def _refused(self, method: Method, answer: Buffer) -> _Work:
        """The server said no: find out why, and raise it."""
        why = reason(answer)
        if not why:  # a server of yarpy can say more about the last failure
            message = yield Bottle([FAILURE]), True
            why, kind = ("", "") if message is None else told(message.to_bytes())
            if kind:
                raise RemoteError(why, kind)
        raise refused(method, why)

    def _speaks_yarp4(self) -> _Work:
        """Return whether the server is of YARP 4: it is asked before the first fraction is sent, or
        the first float32 awaited."""
        if self._yarp4 is None:
            found = yield from self._version()
            self._yarp4 = found is not None and found[1] >= 4
        return self._yarp4

    def _version(self) -> _Work:
        message = yield Payload(Bottle([VERSION]).to_bytes(), version_ending), True
        return None if message is None else version(message.to_bytes())

    def _told(self, method: str, error: YarpError) -> YarpError:
        """An error of the port, with the name of the method."""
        if isinstance(error, LinkClosed):
            self._yarp4 = None  # who comes instead may be another
        if isinstance(error, Timeout):
            return Timeout(f"{method}: no answer within {self.timeout} s")
        if isinstance(error, DecodeError):
            service = type(self).__name__
            return DecodeError(f"{_about(method, error)}; is that port a server of {service}?")
        if isinstance(error, RemoteError) or method in str(error):
            return error
        return type(error)(f"{method}: {error}")

    def __repr__(self) -> str:
        return f"<client of {type(self).__name__}>"


class _Sync(_Client):
    def _call(self, method: Method, values: tuple[Any, ...]) -> Any:
        if method.oneway or (method.minds_version and self._yarp4 is not False):
            return self._run(self._work(method, values))
        # The same in short, where there is nothing to find out first.
        payload = Payload(method.ask(*values), method.ending)
        try:
            message = self._port.ask(payload, self.timeout)
            if message is None:
                return None
            answer = message.to_bytes()
            if is_failure(answer, method, message.spelling == "text"):
                self._run(self._refused(method, answer))
            return method.read_answer(answer)
        except YarpError as error:
            said = self._told(method.name, error)
            if said is error:
                raise
            raise said from error

    def _run(self, work: _Work) -> Any:
        port = self._port
        try:
            payload, question = next(work)
            while True:
                try:
                    answer = port.ask(payload, self.timeout) if question else port.tell(payload)
                except YarpError as error:
                    payload, question = work.throw(error)
                else:
                    payload, question = work.send(answer)
        except StopIteration as done:
            return done.value

    def remote_version(self) -> tuple[int, int, int, int] | None:
        """The version of the server's interface, and of its YARP: `(0, 3, 12, 0)`. None for those
        before 3.12, which do not tell."""
        return self._run(self._version())  # type: ignore[no-any-return]

    def close(self) -> None:
        """End the connection."""
        self._port.close()


class _Async(_Client):
    async def _call(self, method: Method, values: tuple[Any, ...]) -> Any:
        return await self._run(self._work(method, values))

    async def _run(self, work: _Work) -> Any:
        port = self._port
        try:
            payload, question = next(work)
            while True:
                try:
                    wait = port.ask(payload, self.timeout) if question else port.tell(payload)
                    answer = await wait
                except YarpError as error:
                    payload, question = work.throw(error)
                else:
                    payload, question = work.send(answer)
        except StopIteration as done:
            return done.value

    async def remote_version(self) -> tuple[int, int, int, int] | None:
        """As that of the other client."""
        return await self._run(self._version())  # type: ignore[no-any-return]

    async def close(self) -> None:
        """End the connection."""
        await self._port.close()

    async def __aenter__(self) -> Any:
        await self._port.open()
        return self

    async def __aexit__(self, *error: object) -> None:
        await self.close()


def _about(method: str, error: YarpError) -> str:
    """The text of an error, which names the method."""
    return str(error) if method in str(error) else f"{method}: {error}"


def client_class(service: type[Any], waits: bool = False) -> Callable[[Any, Any], Any]:
    """The class of the clients of a service. `waits`: in an event loop."""
    kept = f"_client{waits:d}_"
    found: Callable[[Any, Any], Any] | None = service.__dict__.get(kept)
    if found is None:
        found = _made(service, _Async if waits else _Sync)
        setattr(service, kept, found)
    return found


def check_target(target: str, carrier: str) -> None:
    """Raise AddressError for a target that `client_of` refuses, before it is dialled."""
    apache.spelling(target, carrier)


def client_of(
    service: type[Any],
    port: Any,
    timeout: float | None,
    target: str,
    carrier: str,
    waits: bool = False,
) -> Any:
    """Return a client whose port is connected to `target`, over YARP's wire or as Apache's clients
    are."""
    thrift = apache.spelling(target, carrier)
    if not thrift:
        return client_class(service, waits)(port, timeout)
    base: Any = apache.Async if waits else apache.Sync
    kept = f"_apache_client{waits:d}_"
    found = service.__dict__.get(kept)
    if found is None:
        found = _made(service, base)
        setattr(service, kept, found)
    return found(port, timeout, thrift)


def _made(service: type[Any], base: type[Any]) -> Callable[..., Any]:
    methods = {each.attribute: _call(each) for each in service._methods.values()}
    return type(service.__name__, (base, service), methods)


def _call(method: Method) -> Any:
    """A function with the arguments of a method, which calls it."""
    code = Code()
    arguments = ["self"]
    names = [*method.signature.parameters][1:]
    first = len(names) - len(method.defaults)
    code.globals.update(_method=method, _nothing=_NOTHING)
    for at, name in enumerate(names):
        if at < first:
            arguments.append(name)
            continue
        arguments.append(f"{name}=_nothing")
        code.line(f"if {name} is _nothing: {name} = {code.name(method.defaults[at - first])}()")
    code.line(f"return self._call(_method, ({''.join(f'{name}, ' for name in names)}))")
    made = code.compiled(method.attribute, ", ".join(arguments))
    made.__doc__ = method.doc
    return made


_NOTHING: Final = object()


def is_failure(answer: Buffer, method: Method, text: bool) -> bool:
    """Return whether an answer says that the call failed: `[fail]`, which a false result is not,
    for that comes in a list of mixed elements. (As text both are the same, and a result wins.)"""
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
    """Return the text beside `[fail]`."""
    if len(answer) >= 24 and _HEAD(answer)[1] == 2 and _HEAD(answer, 16)[0] == STRING:
        return str(bytes(answer[24:]), "utf-8", "replace")
    return ""


def told(answer: Buffer) -> tuple[str, str]:
    """The reason that was asked for, and the kind of an exception; "" from servers that know no
    such question."""
    try:
        found = Bottle.from_bytes(spread(answer))
    except DecodeError:
        return "", ""
    if not 0 < len(found) < 3 or type(found[0]) is not str:
        return "", ""
    return found[0], marked(found[-1])


def refused(method: Method, why: str) -> RemoteProtocolError:
    return RemoteProtocolError(
        f"the server refuses {method.name}" + (f": {why}" if why else "; its log may say why")
    )


def version(answer: Buffer) -> tuple[int, int, int, int] | None:
    """The versions in an answer; None if it says none."""
    if len(answer) == _VERSION.size and is_version(*_HEAD(answer)):
        return _VERSION.unpack(answer)[2:]
    try:
        found = Bottle.from_bytes(answer)
    except DecodeError:
        return None
    if len(found) == 4 and all(isinstance(each, int) for each in found):
        service, major, minor, patch = map(int, found)
        return service, major, minor, patch
    return None
