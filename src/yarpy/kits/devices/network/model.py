"""Interface: what a kind of device can do, written once as a class; server and client follow.

    class Lamp(Interface):
        NWS, NWC, RPC = "lamp_nws_yarp", "lamp_nwc_yarp", "rpc"

        @call("set_level_RPC", cpp="setLevel")          a function of the port <name>/rpc
        def dim(self, level: float) -> None: ...

        @published("level:o")                           sent by <name>/level:o, every period
        @call("get_level_RPC", cpp="getLevel")
        def level(self) -> float: ...

        @taken("flash:i", Flash)                        <name>/flash:i reads Flash(es) for it
        def flash(self, seconds: float) -> None: ...

        @sent("colour:o")                               <name>/colour:o gets what it returns
        @call("find_colour_RPC", cpp="findColour")
        def find_colour(self, name: str) -> Colour: ...

    with Lamp.serve("/lamp", MyLamp()), Lamp.connect("/lamp") as lamp:
        lamp.dim(0.5)

Rules: annotations are those of Thrift (`yarpy.kits.thrift`); a tuple is several results, None is
none. In front of the results travels the status of the call, as each version of YARP spells it. A
struct that C++ writes by itself is `Nested`. `cpp` is the name of the method in C++, for `compat`.
What is published but no call is read from that port by clients; what is taken but no call is
written there. None, and a sound of no length, is not sent.

Source: the interfaces of YARP's devices, and how Thrift spells them.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, ClassVar, Final, Self, TypeVar, get_args, get_origin

from yarpy.data.value import Buffer
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.closeable import Closeable
from yarpy.names.base import NameClient

F = TypeVar("F", bound=Callable[..., Any])

_FACTS: Final = "_device_facts"


def call(
    function: str,
    *,
    cpp: str = "",
    status: bool = True,
    boxed: bool = False,
    whole: bool = False,
    words: str = "",
) -> Callable[[F], F]:
    """Mark a member that is called by this function of the network.

    status: False where no status stands in front of the results. boxed: YARP 4 has the status in a
    list of its own where there are no results. whole: the name travels as one word. words: how
    programs of YARP 3 ask for it, where they do not by Thrift (`network.words`); `mode=polr|cart`
    at their end: there stands the last argument, by one of these words.
    """
    spoken, _, choice = words.partition("=")
    facts = {"function": function, "cpp": cpp, "status": status, "boxed": boxed}
    facts["words"] = tuple(spoken.split()[: -1 if choice else None])
    return _mark(**facts, whole=whole, choice=tuple(filter(None, choice.split("|"))))


def sent(port: str) -> Callable[[F], F]:
    """Mark a member whose result, whenever somebody asks for it, is also sent by a port."""
    return _mark(copy=port)


def published(port: str, cpp: str = "", also: str = "") -> Callable[[F], F]:
    """Mark a member whose result is sent by a port. also: one more, where programs of C++ look for
    another than their servers have."""
    return _mark(source=port, also=also, **({"cpp": cpp} if cpp else {}))


def taken(port: str, kind: type[Any], cpp: str = "") -> Callable[[F], F]:
    """Mark a member that is called with what a port reads: a struct's fields, or the message."""
    return _mark(sink=port, sink_kind=kind, **({"cpp": cpp} if cpp else {}))


def _mark(**facts: Any) -> Callable[[F], F]:
    def mark(found: F) -> F:
        setattr(found, _FACTS, {**getattr(found, _FACTS, {}), **facts})
        return found

    return mark


@dataclass(frozen=True, slots=True)
class Member:
    """A method of an interface. `results`: their annotations; the other fields as above."""

    name: str
    doc: str
    signature: inspect.Signature
    results: tuple[Any, ...]
    count: int
    """The number of arguments taken in their order; -1 where some are taken by name alone."""
    function: str = ""
    cpp: str = ""
    status: bool = True
    boxed: bool = False
    whole: bool = False
    words: tuple[str, ...] = ()
    choice: tuple[str, ...] = ()
    copy: str = ""
    source: str = ""
    also: str = ""
    sink: str = ""
    sink_kind: type[Any] | None = None

    @property
    def has_sink(self) -> bool:
        """True if a port is read for it; its name behind the prefix may be empty."""
        return self.sink_kind is not None

    def arguments(self, given: tuple[Any, ...], named: dict[str, Any]) -> tuple[Any, ...]:
        """Return all arguments in their order. Raises TypeError as a call of a function does."""
        if not named and len(given) == self.count:
            return given  # a tenth of a call is saved
        bound = self.signature.bind(None, *given, **named)
        bound.apply_defaults()
        return bound.args[1:]


@dataclass(frozen=True, slots=True)
class Oldest:
    """The answers of programs before YARP 3.10, where they differ by more than the status: `made`
    of those of today, and `read` as those of a function."""

    made: Callable[[Buffer], Buffer]
    read: Callable[[str, Buffer], Buffer]


class Interface:
    """The base of all interfaces, and of the clients that `connect` returns."""

    #: the names in C++ of its server, its client and a simulated device
    NWS: ClassVar[str] = ""
    NWC: ClassVar[str] = ""
    FAKE: ClassVar[str] = ""
    #: the view in C++, and its port for calls, behind the prefix: "" is the prefix itself
    VIEW: ClassVar[str] = ""
    RPC: ClassVar[str] = "rpc"
    #: how YARP 3 answers where it is asked by words: `is` or `ok`, see `network.words`
    WORDS: ClassVar[str] = ""
    #: what is answered to words that are about no member: the numbers behind `is`
    TOLD: ClassVar[dict[str, tuple[int, ...]]] = {}
    #: what programs before YARP 3.10 say otherwise
    OLDEST: ClassVar[Oldest | None] = None
    #: programs before YARP 3.12 do not know it, and those of 4.0 do not say that they are
    ONLY_4: ClassVar[bool] = False
    #: the members, by name
    members: ClassVar[dict[str, Member]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {
            name: _member(name, value)
            for name, value in vars(cls).items()
            if hasattr(value, _FACTS)
        }
        cls.members = {**cls.members, **own}

    @classmethod
    def serve(
        cls,
        name: str,
        device: object,
        period: float = 0.1,
        *,
        newer: bool = False,
        names: NameClient | None = None,
    ) -> Closeable:
        """Serve `device`, an object with some of these methods, to C++ and Python clients.

        name: prefix of the ports. period: seconds between messages of what is published.
        newer: answer programs of YARP 3 as those of 3.12 want it; those of 4.0 are recognised.
        names: a name client, None for the default.
        Raises AddressError (a name is in use), NoNameServer; ValueError if the device has none of
        these methods.
        """
        module = import_module("yarpy.kits.devices.network.server")
        found: Closeable = module.Server(cls, name, device, period, newer=newer, names=names)
        return found

    @classmethod
    def connect(
        cls,
        remote: str,
        local: str = "",
        *,
        carrier: str = "tcp",
        timeout: float = 5.0,
        names: NameClient | None = None,
    ) -> Self:
        """A client of the server whose ports begin with `remote`, C++ or Python.

        local: prefix of the client's own ports; generated if empty.
        timeout: seconds after which published values no longer count.
        names: a name client, None for the default.
        Raises UnknownName, LinkClosed; later Timeout, LocalProtocolError (it refuses).
        """
        module = import_module("yarpy.kits.devices.network.client")
        found: Self = module.client_of(cls)(remote, local, carrier, timeout, names)
        return found

    def close(self) -> None:
        """End the connections of a client."""
        raise LocalProtocolError(f"{type(self).__name__} is no client: nothing to close")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _member(name: str, function: Any) -> Member:
    signature = inspect.signature(function, eval_str=True)
    result = signature.return_annotation
    if result is None or result is inspect.Signature.empty:
        results: tuple[Any, ...] = ()
    else:
        results = get_args(result) if get_origin(result) is tuple else (result,)
    doc = inspect.cleandoc(function.__doc__ or "")
    kinds = [each.kind for each in signature.parameters.values()]
    in_order = all(kind is inspect.Parameter.POSITIONAL_OR_KEYWORD for kind in kinds)
    count = len(kinds) - 1 if in_order else -1
    return Member(name, doc, signature, results, count, **getattr(function, _FACTS))
