"""The contract of a middleware with the decorators: five methods, and what passes through them.

    class Pigeons:
        name = "pigeons"
        def check(self, binding): ...                ValueError for what it cannot do
        def publisher(self, binding, shape): ...     a Publisher
        def listener(self, binding, shape): ...      a Listener
        def server(self, binding, answer): ...       something to close
        def client(self, binding, shape): ...        a Client

Rules: a middleware of another package is found by the entry point group `yarpy.middlewares`, which
names a class without parameters. Whatever waits takes a timeout in seconds, or None for none, and
stops with PortClosed when `close` is called; a client whose server goes away says so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Literal, Protocol, TypeAlias, runtime_checkable

from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, RemoteError
from yarpy.kits.wrap.value.shape import ANY, Shape
from yarpy.qos import Qos

Encoding: TypeAlias = Literal["native", "frame", "wrapyfi"]
Keep: TypeAlias = "Literal['latest', 'all'] | int"

ENCODINGS: Final = ("native", "frame", "wrapyfi")


@dataclass(frozen=True, slots=True, eq=False)
class Parameter:
    """A parameter of a method; `default` is inspect.Parameter.empty where there is none."""

    name: str
    shape: Shape
    default: Any
    keyword_only: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Signature:
    """The parameters of a method, without its object, and its result.

    variable: the name of a parameter that takes any number of arguments, or "".
    """

    name: str
    parameters: tuple[Parameter, ...]
    result: Shape
    variable: str = ""

    @property
    def positional(self) -> tuple[Parameter, ...]:
        """Those that can be given by their place."""
        return tuple(one for one in self.parameters if not one.keyword_only)


@dataclass(frozen=True, slots=True)
class Binding:
    """One middleware for one value: where it goes, and how.

    place: what stands behind the name in "mqtt://broker:1883", or "".
    signature: of the method, where it is known: for middlewares whose requests have types.
    """

    topic: str
    middleware: str = "yarp"
    place: str = ""
    carrier: str = ""
    qos: Qos | None = None
    keep: Keep = "latest"
    reliable: bool = False
    encoding: Encoding = "native"
    signature: Signature | None = None

    def refuse(self, **needed: str) -> None:
        """Raise ValueError for an option that this middleware does not have: `carrier="why"`."""
        for name, why in needed.items():
            if getattr(self, name) != getattr(_PLAIN, name):
                raise ValueError(f"{name}={getattr(self, name)!r} on {self.middleware}: {why}")

    def refuse_numbers(self) -> None:
        """Raise ValueError for a number of values to keep, where the ends are ports."""
        if self.keep not in ("latest", "all"):
            raise ValueError('a port keeps "latest" or "all" of what comes')


_PLAIN: Final = Binding("")
_TEXT: Final = frozenset((str,))


class Item:
    """A value on its way out: plain Python (`shape.dump`), its number and time.

    `forms` holds what middlewares have made of it, where there are several.
    """

    __slots__ = ("count", "forms", "plain", "shape", "source", "time")

    def __init__(
        self, plain: Any, shape: Shape = ANY, count: int = 0, time: float = 0.0, source: str = ""
    ) -> None:
        self.plain = plain
        self.shape = shape
        self.count = count
        self.time = time
        self.source = source
        self.forms: dict[str, Any] | None = None

    def form(self, name: str, make: Callable[[Item], Any]) -> Any:
        """Return `make(item)`; where `forms` is a dict, it is made once and kept there."""
        if self.forms is None:
            return make(self)
        if name not in self.forms:
            self.forms[name] = make(self)
        return self.forms[name]


@dataclass(slots=True)
class Received:
    """A value that came: `count` and `time` (seconds since 1970) are its sender's, None if it sent
    none; `source` names the sender where it is known, `middleware` the one that brought it."""

    value: Any
    count: int | None = None
    time: float | None = None
    source: str = ""
    middleware: str = ""

    @property
    def stamp(self) -> Stamp | None:
        """Count, in 31 bits, and time as a Stamp."""
        if self.count is None or self.time is None:
            return None
        return Stamp(self.count & 0x7FFFFFFF, self.time)


class Heard(Received):
    """A value that came with an envelope, whose count and time are read when somebody asks: that
    takes as long as reading a small value."""

    __slots__ = ("envelope",)

    def __init__(self, value: Any, envelope: str, source: str, middleware: str) -> None:
        self.value = value
        self.envelope = envelope
        self.source = source
        self.middleware = middleware

    def __repr__(self) -> str:
        return super().__repr__().replace("Heard(", "Received(", 1)

    def __getattr__(self, name: str) -> Any:
        """Read the envelope: `count` and `time` are not set yet."""
        if name not in ("count", "time"):
            raise AttributeError(f"a value that came has no {name}")
        try:
            stamp = Stamp.from_text(self.envelope) if self.envelope else None
        except DecodeError:
            stamp = None
        self.count, self.time = (stamp.count, stamp.time) if stamp is not None else (None, None)
        return self.count if name == "count" else self.time


@dataclass(slots=True)
class Failure:
    """The answer of a server whose method raised an exception."""

    type: str
    text: str

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        return cls(type(error).__name__, str(error))

    def error(self) -> RemoteError:
        return RemoteError(self.text, self.type)


#: what a server calls with the arguments of a question: Item or Failure
Answer: TypeAlias = "Callable[[list[Any], dict[str, Any]], Item | Failure]"


@runtime_checkable
class Publisher(Protocol):
    """Sends values to a topic. Any thread may."""

    def publish(self, item: Item) -> int:
        """Send it; how many took it, as far as that is known."""
        ...

    def wait(self, timeout: float | None) -> bool:
        """Wait until somebody listens, as far as that can be known; False if time is over."""
        ...

    @property
    def stats(self) -> dict[str, Any]: ...

    def close(self) -> None: ...


@runtime_checkable
class Listener(Protocol):
    """Takes the values of a topic. One thread at a time."""

    def listen(self, timeout: float | None) -> Received:
        """The next value. Raises Timeout, PortClosed; DecodeError for what is something else."""
        ...

    @property
    def stats(self) -> dict[str, Any]: ...

    def close(self) -> None: ...


@runtime_checkable
class Client(Protocol):
    """Asks a server. Any number of threads may, at the same time."""

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        """The answer. Raises RemoteError, Timeout, LinkClosed when the server goes away meanwhile,
        UnknownName when there is none, DecodeError."""
        ...

    def close(self) -> None: ...


class Server(Protocol):
    def close(self) -> None: ...


class Middleware(Protocol):
    name: str

    def check(self, binding: Binding) -> None: ...

    def publisher(self, binding: Binding, shape: Shape) -> Publisher: ...

    def listener(self, binding: Binding, shape: Shape) -> Listener: ...

    def server(self, binding: Binding, name: str, answer: Answer) -> Server: ...

    def client(self, binding: Binding, shape: Shape) -> Client: ...


def question_of(value: Any) -> tuple[list[Any], dict[str, Any]]:
    """The arguments of a question that came as `[args, kwargs]`. Raises DecodeError."""
    if (
        not isinstance(value, (list, tuple))
        or len(value) != 2
        or not isinstance(value[0], (list, tuple))
        or not isinstance(value[1], dict)
        or not _TEXT.issuperset(map(type, value[1]))
    ):
        raise DecodeError("a question is [arguments, arguments by name]")
    return list(value[0]), value[1]
