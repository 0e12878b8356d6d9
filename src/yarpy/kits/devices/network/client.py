"""Client: any interface of devices of a remote server, C++ or Python, used like a local device.

Rules: it has every member of the interface, so it can be served again. What the server refuses is a
LocalProtocolError with its reason. Values that are only published are the latest; Timeout if none
is fresh. Ports of the server that it has not are missed when they are used.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, ClassVar, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, RemoteError, RemoteProtocolError
from yarpy.kits.devices.closeable import local_prefix, prefix
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.latest_message import LatestMessage
from yarpy.kits.devices.network.functions import functions_of
from yarpy.kits.devices.network.model import Interface, Member
from yarpy.kits.devices.network.words import question, results
from yarpy.kits.devices.status import OK, reason
from yarpy.kits.thrift.client import client_class
from yarpy.kits.thrift.structure import Struct
from yarpy.names.base import NameClient
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0

_KNOWN: Final[dict[type[Interface], Callable[..., Any]]] = {}


def client_of(interface: type[Interface]) -> Callable[..., Any]:
    """Return the class of the clients of an interface."""
    found = _KNOWN.get(interface)
    if found is None:
        methods: dict[str, Any] = {each.name: _method(each) for each in interface.members.values()}
        methods["__module__"] = interface.__module__
        found = _KNOWN[interface] = type(interface.__name__, (_Remote, interface), methods)
    return found


class _Remote:
    """The base of all clients, in front of their interface."""

    members: ClassVar[dict[str, Member]]
    RPC: ClassVar[str]
    WORDS: ClassVar[str]

    def __init__(
        self, remote: str, local: str, carrier: str, timeout: float, names: NameClient | None
    ) -> None:
        self.remote = remote = prefix(remote)
        self._local = local_prefix(local, remote)
        self._carrier, self._timeout, self._names = carrier, timeout, names
        self._latest: dict[str, LatestMessage[Any]] = {}
        self._sinks: dict[str, Port] = {}
        self._lock = threading.Lock()  # a stream is listened to once
        self._functions: Any = None
        self._rpc: Any = None
        self._in_words: bool | None = None  # whether it is asked in words; None: find out
        members = self.members.values()
        with ExitStack() as resources:
            self._open = resources
            if any(each.function for each in members):
                rpc = resources.enter_context(
                    RpcClient(
                        f"{remote}/{self.RPC}".rstrip("/"), name=f"{self._local}/rpc:o", names=names
                    )
                )
                self._functions = client_class(functions_of(_interface(type(self))))(rpc, TIMEOUT)
                self._rpc = rpc
            for each in members:
                # What is asked by calls may never need the streams beside them.
                if each.source and not each.function and self._functions is None:
                    self._listen(each)
            self._open = resources.pop_all()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.remote}>"

    def close(self) -> None:
        """Close the ports. Idempotent."""
        self._open.close()

    def _listen(self, each: Member) -> None:
        def decode(message: Message) -> Any:
            return message.as_(_class_of(each))

        self._latest[each.name] = self._open.enter_context(
            LatestMessage(
                f"{self.remote}/{each.source}",
                f"{self._local}/{each.source.removesuffix(':o')}:i",
                self._carrier,
                self._timeout,
                self._names,
                decode,
            )
        )

    def _heard(self, each: Member) -> Any:
        """The newest value of a stream, which is listened to from now on."""
        with self._lock:
            if each.name not in self._latest:
                self._listen(each)
        return self._latest[each.name].value()

    def _sink(self, each: Member) -> Port:
        port = self._sinks.get(each.name)
        if port is None:
            name = f"{self._local}/{each.sink.removesuffix(':i') or 'data'}:o"
            port = Port(name, names=self._names)
            self._open.enter_context(port)
            port.connect(f"{self.remote}/{each.sink}".rstrip("/"), carrier=self._carrier)
            self._sinks[each.name] = port
        return port

    def _ask(self, each: Member, values: tuple[Any, ...]) -> Any:
        if each.words and self._speaks_in_words():
            return self._say(each, values)
        try:
            answer = getattr(self._functions, each.function)(*values)
        except RemoteError:
            raise
        except RemoteProtocolError as error:
            raise LocalProtocolError(f'"{self.remote}" refuses {each.name}: {error}') from error
        if not each.status:
            return answer
        code = answer.code if isinstance(answer, Status) else answer.status.code
        if code != OK:
            raise LocalProtocolError(f'"{self.remote}" refuses {each.name}: {reason(code)}')
        found = tuple(getattr(answer, f"value{at}") for at in range(len(each.results)))
        return found[0] if len(found) == 1 else found or None

    def _speaks_in_words(self) -> bool:
        """Return whether the server is of YARP 3, where it knows no Thrift."""
        if self._in_words is None:
            self._in_words = self._functions.remote_version() is None
        return self._in_words

    def _say(self, each: Member, values: tuple[Any, ...]) -> Any:
        message = self._rpc.ask(question(each, values), TIMEOUT)
        found = results(each, self.WORDS, message.as_(Bottle))
        if found is None:
            raise LocalProtocolError(f'"{self.remote}" refuses {each.name}: {reason("fail")}')
        return found[0] if len(found) == 1 else found or None

    def _put(self, each: Member, values: tuple[Any, ...]) -> None:
        kind: Any = each.sink_kind
        if isinstance(kind, type) and issubclass(kind, Struct):
            message: Any = kind(*values[: len(kind._attributes)])
        else:
            message = values[0]
        if not self._sink(each).write(message):
            raise LocalProtocolError(f'"{self.remote}/{each.sink}" takes nothing: is it there?')


def _interface(client: type[Any]) -> type[Interface]:
    found: type[Interface] = client.__mro__[2]  # behind the client's own class and _Remote
    return found


def _class_of(each: Member) -> Any:
    from yarpy.kits.thrift.kind import External, Scalar, kind_of
    from yarpy.kits.thrift.wire.reader import class_of

    annotation = each.results[0]
    try:
        kind = kind_of(annotation, {})[0]
    except TypeError:
        return annotation
    if isinstance(kind, Scalar):
        return annotation
    return class_of(kind) if isinstance(kind, External) else kind


def _method(each: Member) -> Any:
    if each.function:

        def function(self: _Remote, *given: Any, **named: Any) -> Any:
            return self._ask(each, each.arguments(given, named))

    elif each.source:

        def function(self: _Remote, *given: Any, **named: Any) -> Any:
            return self._heard(each)

    else:

        def function(self: _Remote, *given: Any, **named: Any) -> Any:
            return self._put(each, each.arguments(given, named))

    made: Any = function
    made.__name__, made.__doc__, made.__signature__ = each.name, each.doc, each.signature
    return made
