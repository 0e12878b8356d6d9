"""Server: any interface of devices on ports, as its class says.

Rules: the device is used by one thread at a time. What it lacks, and what it raises, is told by the
status of the answer; the log says why. Nothing is read while nobody listens. Readers of YARP 4 get
floats as it spells them, and sounds. (Those of 3.10 to 3.12 are told by `newer` alone.)
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from reprlib import repr as shown
from typing import Any

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.sound import Sound
from yarpy.data.stamp import Stamp
from yarpy.data.value import Buffer
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.network.functions import functions_of
from yarpy.kits.devices.network.model import Interface, Member
from yarpy.kits.devices.network.words import answer, arguments, asked, fixed
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.kits.devices.status import FAILED, MISSING, OK, older, oldest
from yarpy.kits.thrift.structure import Struct
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Message

log = logger("yarpy.devices")


class Server(Closeable):
    """Serves a device; see `Interface.serve`."""

    def __init__(
        self,
        interface: type[Interface],
        name: str,
        device: object,
        period: float,
        *,
        newer: bool,
        names: NameClient | None,
    ) -> None:
        self.interface = interface
        self.name = name = prefix(name)
        self.device = device
        self._newer = newer
        self._complain = DeviceErrorLog(name)
        self._access = Access(device, 0, self._complain, threading.Lock())
        if not self._access.offers(interface.members):
            there = ", ".join(interface.members)
            raise ValueError(f"{name}: the device has none of {there}")
        members = [each for each in interface.members.values() if self._access.has(each.name)]
        self._stamp = Stamp()
        with ExitStack() as resources:
            if any(each.function for each in interface.members.values()):
                functions = functions_of(interface)(self._perform)
                oldest_ = _same if interface.ONLY_4 else partial(_oldest, interface)
                functions.before = older if newer else oldest_
                functions._yarp = (3, 12, 0) if newer else (3, 10, 0)  # type: ignore[misc]
                if interface.WORDS:
                    functions.said = self._said
                rpc = f"{name}/{interface.RPC}".rstrip("/")
                resources.enter_context(RpcServer(rpc, functions, names=names))
            self._sources: list[tuple[Member, Dialects]] = []
            self._copies: dict[str, Dialects] = {}
            for each in members:
                if each.copy:
                    copies = BufferedPort(f"{name}/{each.copy}", names=names)
                    self._copies[each.name] = Dialects(resources.enter_context(copies))
            for each in members:
                if each.has_sink:
                    take = partial(self._take, each)
                    sink = f"{name}/{each.sink}".rstrip("/")
                    resources.enter_context(BufferedPort(sink, callback=take, names=names))
                for source in filter(None, (each.source, each.also)):
                    port = BufferedPort(f"{name}/{source}", names=names)
                    resources.enter_context(port)
                    self._sources.append((each, Dialects(port)))
            if self._sources:
                publisher = Publisher(name, period, self._publish)
                resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<server of {self.interface.__name__} {self.name}>"

    def _perform(self, each: Member, answer: type[Any] | None, arguments: tuple[Any, ...]) -> Any:
        """Do what is asked: the results behind a status, or the only result."""
        if answer is None:
            return self._access.ask(each.name, *arguments)
        if not self._access.has(each.name):
            log.info("%s: the device has no %s", self.name, each.name)
            return _status(answer, MISSING)
        try:
            found = self._results(each, arguments)
        except Refused as refusal:
            log.info("%s: %s", self.name, refusal)
            return _status(answer, FAILED)
        return answer(OK) if answer is Status else answer(Status(OK), *found)

    def _results(self, each: Member, arguments: tuple[Any, ...]) -> tuple[Any, ...]:
        found = self._access.ask(each.name, *arguments)
        if not each.results:
            return ()
        values = (found,) if len(each.results) == 1 else tuple(found)
        if len(values) != len(each.results):
            raise Refused(f"{each.name} gives {len(values)} values, not {len(each.results)}")
        readers = self._copies.get(each.name)
        if readers:
            self._send(readers, values[0] if len(values) == 1 else Bottle(values), None)
        if self._newer:
            return tuple(_of_3_10(value) if isinstance(value, Sound) else value for value in values)
        return values

    def _said(self, message: Message) -> Bottle | None:
        """Answer a request in words; None if it is none."""
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return None
        if (told := fixed(self.interface.TOLD, request)) is not None:
            return told
        each = asked(self.interface.members.values(), request)
        if each is None:
            return None
        found: tuple[Any, ...] | None = None
        try:
            found = self._results(each, arguments(each, request))
        except (Refused, DecodeError) as error:
            log.info("%s: %s: %s", self.name, shown([*request]), error)
        return answer(each, self.interface.WORDS, found)

    def _take(self, each: Member, message: Message) -> None:
        kind: Any = each.sink_kind
        try:
            found = message.as_(kind)
            fields = isinstance(found, Struct)
            values = [getattr(found, name) for name in kind._attributes] if fields else [found]
            self._results(each, each.arguments(tuple(values), {}))
        except (DecodeError, Refused) as error:
            self._complain(each.sink, error)

    def _publish(self) -> None:
        stamp: Stamp | None = None
        for each, readers in self._sources:
            if not readers:
                continue
            try:
                found = self._access.ask(each.name)
            except Refused as refusal:
                self._complain(each.source, refusal)
                continue
            if found is None or getattr(found, "length", 1) == 0:
                continue
            stamp = stamp or self._next_stamp()
            self._send(readers, found, stamp)

    def _send(self, readers: Dialects, found: Any, stamp: Stamp | None) -> None:
        older_form: Callable[[], object] = lambda: found  # noqa: E731
        newer_form = older_form
        if isinstance(found, Sound):
            newer_form = lambda: found.to_bottle("4.0")  # noqa: E731
            if self._newer:
                older_form = lambda: found.to_bottle("3.10")  # noqa: E731
        elif isinstance(found, Struct):
            data = found.to_wire()[0]
            older_form, newer_form = lambda: Encoded(data), lambda: Encoded(to_yarp4(data))
            if not self._newer and hasattr(found, "older"):
                older_form = found.older
        elif isinstance(found, Bottle):
            data = found.to_bytes()
            older_form, newer_form = lambda: Encoded(data), lambda: Encoded(to_yarp4(data))
        readers.write(older_form, newer_form, stamp)

    def _next_stamp(self) -> Stamp:
        self._stamp = self._stamp.next(clock.now())
        return self._stamp


def _same(answer: Buffer) -> Buffer:
    return answer


def _oldest(interface: type[Interface], answer: Buffer) -> Buffer:
    """An answer as programs before YARP 3.10 want it."""
    answer = oldest(answer)
    return interface.OLDEST.made(answer) if interface.OLDEST else answer


def _status(answer: type[Any], code: str) -> Any:
    return answer(code) if answer is Status else answer(Status(code))


def _of_3_10(sound: Sound) -> Sound:
    """The same sound, which goes over the network as YARP 3.10 to 3.12 have it."""
    return _Sound310(sound.array, sound.frequency)


class _Sound310(Sound):
    """A Sound in the form of YARP 3.10."""

    __slots__ = ()

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """A Bottle."""
        return (self.to_bottle("3.10").to_bytes(),)
