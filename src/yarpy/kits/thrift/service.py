"""Service: what a server subclasses, and what a client has the methods of.

    class Camera(camera.Camera):                  yarpy.RpcServer("/cam/rpc", Camera())
        def set_speed(self, speed): ...           camera.connect("/cam/rpc").set_speed(1.5)

    name of a method    one word, or the words between its `_`, as strings or vocabs
    help, help NAME     the names of the methods; one of them with its documentation
    getRemoteProtocolVersion      `const i16 protocol_version` of the file, and 3 12 0
    help_failure        (yarpy) why the last call of this client failed

Rules: every request is answered, a failed one with `[fail]`: alone for programs, as in C++, since
they cannot read more; with the reason for people and whoever spells names as people do. A method
may be a coroutine function where `yarpy.aio.RpcServer` serves it. What a method raises is logged,
and is the reason; with a YarpError it only refuses. Inherited methods are called as own ones. A
oneway call is answered before it is done, where somebody wants an answer. Floats are spelled as the
client does: as YARP 4.0 for who sent some that way, or asked for the version, as its clients do.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Awaitable, Mapping
from inspect import isawaitable
from struct import Struct as Packing
from typing import Any, ClassVar, Final, Self

from yarpy import registry
from yarpy.data.bottle import Bottle
from yarpy.data.failure import answer_of, error_of, mark, raised
from yarpy.data.value import LIST, STRING, Int16, Vocab
from yarpy.data.yarp4 import is_yarp4
from yarpy.errors import DecodeError, LocalProtocolError, RemoteError, YarpError
from yarpy.kits.thrift.apache import serve
from yarpy.kits.thrift.apache.message import Call
from yarpy.kits.thrift.kind import namespace_of
from yarpy.kits.thrift.method import Method, first_word
from yarpy.kits.thrift.payload import FAILURE, VERSION, Payload, many
from yarpy.kits.thrift.wire.cursor import spread
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES

log = logger("yarpy.idl")

#: what others are told the version of YARP is whose wire this is
YARP_VERSION: Final = (3, 12, 0)
YARP_4: Final = (4, 0, 0)

_DIRECT: Final = "__direct__"
#: clients whose last failure, or way to spell floats, is remembered
_REMEMBERED: Final = 100
_FAILED: Final = Packing("<iii").pack(LIST + 9, 1, 0x6C696166)
_DONE: Final = Packing("<iiii").pack(LIST, 1, 9, 0x656E6F64)


class Service:
    """The base of all services."""

    _thrift: ClassVar[str] = "service"
    _version: ClassVar[int] = 0
    _methods: ClassVar[dict[str, Method]] = {}
    _namespace: ClassVar[Mapping[str, Any] | None] = None
    #: all clients are of YARP 4, as those of its devices
    _only_yarp4: ClassVar[bool] = False
    #: what they are told the version of YARP is
    _yarp: ClassVar[tuple[int, int, int]] = YARP_VERSION
    _failures: OrderedDict[str, tuple[str, str]]
    _spellings: OrderedDict[str, bool] = OrderedDict()  # of nobody: never filled

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {
            method.name: method
            for method in (
                Method(name, value, lambda owner=cls: namespace_of(owner))  # type: ignore[misc]
                for name, value in cls.__dict__.items()
                if hasattr(value, "_thrift_oneway")
            )
        }
        cls._methods = {**cls._methods, **own}

    # -- serving ----------------------------------------------------------------------------------

    def __call__(self, message: Any) -> Any:
        """Answer a message: a Service is the handler of an RpcServer."""
        if isinstance(message, Call):
            return serve.answer(self, message)
        person = message.spelling == "text" or message.source == "web"
        try:
            data = bytes(spread(message.to_bytes()))
            name, at, by_hand = self._named(data)
            person = person or by_hand
            method = self._methods.get(name)
            if method is None:
                return self._extra(name, data, at, message)
            try:
                values = method.read_arguments(data, at)
            except DecodeError as error:
                values = method.yarp4_arguments(data, at, error)
                self._note(message.source, True)
            else:
                if message.source in self._spellings and method.asks_floats and _is_yarp3(data):
                    self._note(message.source, False)
            function = getattr(self, method.attribute)
            if method.oneway and message.wants_reply:
                message.reply(Payload(_DONE))
            result = function(*values)
            if isawaitable(result):
                return self._finished(method, result, message, person)
        except FAILURES as error:
            return self._failed(error, message, person)
        return self._answer(method, result, message, person)

    def _answer(self, method: Method, result: Any, message: Any, person: bool) -> Any:
        if method.oneway:
            return None
        try:
            if person:
                return Payload(method.bottle_answer(result))
            if method.answers_floats and self._is_yarp4(message.source):
                return Payload(method.yarp4_answer(result))
            return Payload(method.answer(result))
        except Exception as error:
            return self._failed(error, message, person)

    async def _finished(
        self, method: Method, result: Awaitable[Any], message: Any, person: bool
    ) -> Any:
        try:
            found = await result
        except FAILURES as error:
            return self._failed(error, message, person)
        return self._answer(method, found, message, person)

    def _note(self, source: str, yarp4: bool) -> None:
        """Remember how a client spells floats."""
        if "_spellings" not in self.__dict__:
            self._spellings = OrderedDict()
        known = self._spellings
        known.pop(source, None)
        if yarp4:
            known[source] = True
            while len(known) > _REMEMBERED:
                known.popitem(last=False)

    def _is_yarp4(self, source: str) -> bool:
        """Return whether answers to a client are those of YARP 4.0."""
        return self._only_yarp4 or source in self._spellings

    def _named(self, data: bytes) -> tuple[str, int, bool]:
        """The method that a request names, where its arguments begin, and whether it is spelled as
        people do. What is not a method is its first word."""
        word, at, tag = first_word(data, 8)
        if word == _DIRECT:
            word, at, tag = first_word(data, at)
        methods = self._methods
        name = word
        by_hand = tag == STRING and (len(word) <= 4 or "_" in word)
        found = word, at, by_hand  # the other words are arguments, perhaps
        for _ in range(self._longest()):
            if name in methods:
                found = name, at, by_hand
                if name not in self._shorter():
                    break
            if name in ("help", VERSION, FAILURE) or at >= len(data):
                break
            try:
                word, at, tag = first_word(data, at)
            except DecodeError:
                break
            by_hand = by_hand or (tag == STRING and len(word) <= 4)
            name = f"{name}_{word}"
        return found

    def _shorter(self) -> frozenset[str]:
        """The names that others begin with: `get` beside `get_all`, which is what `get all` is."""
        found: frozenset[str] | None = type(self).__dict__.get("_shorter_")
        if found is None:
            begins = {
                "_".join(each.words[:at])
                for each in self._methods.values()
                for at in range(1, len(each.words))
            }
            found = type(self)._shorter_ = frozenset(begins & self._methods.keys())  # type: ignore[attr-defined]
        return found

    def _longest(self) -> int:
        """The words of the longest name."""
        found = type(self).__dict__.get("_longest_")
        if found is None:
            found = max((len(each.words) for each in self._methods.values()), default=1)
            type(self)._longest_ = found  # type: ignore[attr-defined]
        return int(found)

    def _extra(self, name: str, data: bytes, at: int, message: Any) -> Any:
        """Answer a name that every service has beside its methods."""
        if name == "help":
            asked = first_word(data, at)[0] if at < len(data) else ""
            return Payload(many(self.help(asked)))
        if at == len(data) and name == VERSION:
            numbers = (self._version, *self._yarp)
            self._note(message.source, True)  # programs before 4.0 do not ask
            if message.spelling == "text":
                return Bottle([Int16(number) for number in numbers])
            return Payload(Packing("<iihhhh").pack(LIST, 1, *numbers))
        if at == len(data) and name == FAILURE:
            reason, kind = self._remembered().get(message.source, ("", ""))
            return Bottle([reason, mark(kind)] if kind else [reason])
        known = ", ".join([*self._methods][:8]) + (" ..." if len(self._methods) > 8 else "")
        raise DecodeError(f'no method "{name[:60]}": there are {known}; send help for all')

    def _reason(self, error: Exception | SystemExit, message: Any) -> tuple[str, str]:
        """Log why a request has failed; the type of an exception, "" for a refusal, and a text."""
        kind = ""
        if isinstance(error, YarpError) and not isinstance(error, RemoteError):
            reason = str(error)
            log.warning("%s: request of %s: %s", type(self).__name__, message.source, reason)
        elif isinstance(error, NotImplementedError):
            reason = f"{type(self).__name__} does not have this method"
            log.warning("%s: request of %s: %s", type(self).__name__, message.source, reason)
        else:
            failed = error_of(answer_of(error))
            assert failed is not None
            kind, reason = failed.type, failed.text
            words = (type(self).__name__, message.source)
            log_failure(log, error, "%s failed on a request of %s", *words)
        return kind, reason

    def _failed(self, error: Exception | SystemExit, message: Any, person: bool) -> Any:
        kind, reason = self._reason(error, message)
        if not message.wants_reply:
            return None
        if person:
            return raised(kind, reason) if kind else Bottle([Vocab("fail"), reason])
        failures = self._remembered()
        failures.pop(message.source, None)
        failures[message.source] = reason[:1000], kind
        while len(failures) > _REMEMBERED:
            failures.popitem(last=False)
        return Payload(_FAILED)

    def _remembered(self) -> OrderedDict[str, tuple[str, str]]:
        found: OrderedDict[str, tuple[str, str]] | None = self.__dict__.get("_failures")
        if found is None:
            found = self.__dict__.setdefault("_failures", OrderedDict())
        return found

    def help(self, name: str = "") -> list[str]:
        """The names of all methods; or how one is called, and what it says about itself."""
        if not name or name == "--all":
            return ["*** Available commands:", *self._methods, "help"]
        method = self._methods.get(name)
        if method is None:
            return ["Command not found"]
        return [method.prototype, *([method.doc] if method.doc else [])]

    def page(self, path: str, fields: Mapping[str, str]) -> str | None:
        """The page of the server's port: its methods as forms."""
        from yarpy.kits.thrift.page import page

        return page(self) if path == "/" else None

    # -- calling ----------------------------------------------------------------------------------

    @classmethod
    def connect(
        cls, target: str, *, timeout: float | None = None, carrier: str = "", **options: Any
    ) -> Self:
        """A client of the server `target`, with the methods of this service.

        A call raises Timeout after `timeout` seconds, RemoteProtocolError if the server refuses it,
        LinkClosed if it is gone; all name the method. A server that is silent when it is dialled is
        waited for as long, too: LinkClosed. `options` are those of `yarpy.RpcClient`.
        `with`, or `close()`, ends the connection.
        """
        from yarpy.kits.thrift.client import check_target, client_of

        check_target(target, carrier)
        port = registry.clients.load("rpc")(target, carrier=carrier, timeout=timeout, **options)
        return client_of(cls, port, timeout, target, carrier)  # type: ignore[no-any-return]

    @classmethod
    def __remote__(cls, port: Any, timeout: float | None = None, waits: bool = False) -> Self:
        """A client whose calls go through `port`, which is connected to a server: what the `remote`
        of a `RpcClient[...]` is. With `waits` its methods are awaited. Errors as of `connect`."""
        from yarpy.kits.thrift.client import client_of

        target, carrier = port._target, port._carrier
        return client_of(cls, port, timeout, target, carrier, waits)  # type: ignore[no-any-return]

    @classmethod
    def connect_async(
        cls, target: str, *, timeout: float | None = None, carrier: str = "", **options: Any
    ) -> Any:
        """The same for event loops: `async with` it, and await its methods."""
        from yarpy.kits.thrift.client import check_target, client_of

        check_target(target, carrier)
        port = registry.clients.load("aio")(target, carrier=carrier, timeout=timeout, **options)
        return client_of(cls, port, timeout, target, carrier, waits=True)

    def close(self) -> Any:
        """End the connection of a client."""
        raise LocalProtocolError(f"{type(self).__name__} is no client: nothing to close")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _is_yarp3(data: bytes) -> bool:
    """Return whether only YARP 3 spells a request like that. No Bottle: a Sound of 3.9."""
    try:
        return is_yarp4(data) is False
    except DecodeError:
        return True
