"""ControllerServer: what the servers of the Cartesian and of the gaze controller have in common.

    <name>/events:o     motion-onset, motion-ongoing, motion-done ...

Rules: questions and commands come one at a time. What is not understood, and what the device
refuses, is `[nack]`, and logged. Events come from the motion of the device, which is looked at
every period.
"""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any, ClassVar, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import YarpError
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.controllers.client import VERSION
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message

#: What a device may raise when it cannot do something.
WRONG: Final = (
    *(AttributeError, IndexError, KeyError, LookupError, TypeError, ValueError),
    *(OverflowError, Refused, YarpError),
)
#: Contexts and shares of the way that are kept.
_MANY: Final = 100


class ControllerServer(Closeable):
    """Serves `device`, which has the members of the client.

    name: the prefix of the ports. period: seconds between two states.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer.
    """

    RPC: ClassVar[str]
    #: ports that take commands, ports of numbers -> members that tell them
    COMMANDS: ClassVar[Sequence[str]]
    STATES: ClassVar[dict[str, str]]
    #: members that a context keeps
    SETTINGS: ClassVar[Sequence[str]]

    def __init__(
        self, name: str, device: Any, period: float = 0.02, *, names: NameClient | None = None
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._lock = threading.Lock()
        self._complain = DeviceErrorLog(name)
        self._contexts: list[dict[str, Any] | None] = [self._settings()]
        self._shares: set[float] = set()
        self._passed: set[float] = set()
        self._done = True
        self._stamp = Stamp()
        with ExitStack() as resources:
            enter = resources.enter_context
            self._events = enter(BufferedPort(f"{name}/events:o", names=names))
            self._events.strict = True  # the end of a motion may follow its beginning at once
            self._out = {
                each: enter(BufferedPort(f"{name}/{each}:o", names=names)) for each in self.STATES
            }
            for each in self.COMMANDS:
                port = BufferedPort(f"{name}/{each}:i", callback=self._taking(each), names=names)
                enter(port).read_strictly()
            enter(RpcServer(f"{name}/{self.RPC}", self._answer, names=names))
            publisher = Publisher(name, period, self._publish)
            resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}>"

    def get(self, item: str, rest: Sequence[Any]) -> list[Any]:
        """Answer a question. Raises one of WRONG."""
        raise NotImplementedError

    def set(self, item: str, rest: Sequence[Any]) -> list[Any]:
        """Change a setting; what is to be told then."""
        raise NotImplementedError

    def act(self, verb: str, rest: Sequence[Any]) -> list[Any]:
        """Do something else that was asked for."""
        raise NotImplementedError

    def command(self, port: str, words: Sequence[Any]) -> None:
        """Do what came to a port of commands."""
        raise NotImplementedError

    # -- within -------------------------------------------------------------------------------

    def _settings(self) -> dict[str, Any]:
        return {each: copy.deepcopy(getattr(self.device, each)) for each in self.SETTINGS}

    def _info(self) -> Bottle:
        return Bottle([Bottle(["server_version", VERSION])])

    def _taking(self, port: str) -> Callable[[Message], None]:
        def take(message: Message) -> None:
            try:
                with self._lock:
                    self.command(port, [*message.as_(Bottle)])
                self._begun()
            except WRONG as error:
                self._complain(port, error)

        return take

    def _answer(self, message: Message) -> object:
        try:
            words = [*message.as_(Bottle)]
            with self._lock:
                found = self._respond(word(words[0]), words[1:])
        except WRONG as error:
            self._complain("questions", error)
            return Bottle([Vocab("nack")])
        self._begun()
        return Bottle([Vocab("ack"), *found])

    def _respond(self, verb: str, rest: Sequence[Any]) -> list[Any]:
        if verb == "get":
            return [self._info()] if word(rest[0]) == "info" else self.get(word(rest[0]), rest[1:])
        if verb == "set":
            return self.set(word(rest[0]), rest[1:])
        if verb == "stop":
            self.device.stop()
            return []
        if verb == "stor":
            if len(self._contexts) >= _MANY:
                raise Refused("too many contexts: delete some")
            self._contexts.append(self._settings())
            return [len(self._contexts) - 1]
        if verb == "rest":
            kept = self._contexts[self._number(rest[0])]
            for name, value in (kept or {}).items():
                setattr(self.device, name, copy.deepcopy(value))
            return []
        if verb == "del":
            for each in rest[0]:
                if each:
                    self._contexts[self._number(each)] = None
            while self._contexts[-1] is None:
                self._contexts.pop()
            return []
        return self.act(verb, rest)

    def _number(self, value: Any) -> int:
        number = int(value)
        if not 0 <= number < len(self._contexts) or self._contexts[number] is None:
            raise Refused(f"there is no context {value}")
        return number

    def _share(self, register: bool, value: Any) -> list[Any]:
        share = float(value)
        if not register:
            self._shares.discard(share)
        elif len(self._shares) >= _MANY or not 0.0 <= share <= 1.0:
            raise Refused(f"a share of the way is from 0 to 1, and there are {_MANY} at most")
        else:
            self._shares.add(share)
        return []

    # -- events and states --------------------------------------------------------------------

    def _begun(self) -> None:
        """Tell that a motion has begun, if one has."""
        if self._done and not self.device.motion_done():
            self._done = False
            self._passed.clear()
            self._tell("motion-onset")

    def _publish(self) -> None:
        with self._lock:
            done, share = self.device.motion_done(), self.device.progress()
            told = {
                each: getattr(self.device, member)()
                for each, member in self.STATES.items()
                if self._out[each].outputs
            }
        self._stamp = self._stamp.next(clock.now())
        for each, values in told.items():
            self._out[each].write(Vector([float(value) for value in values]), self._stamp)
        if self._done:
            return
        for wanted in sorted(self._shares - self._passed):
            if share >= wanted:
                self._passed.add(wanted)
                self._tell("motion-ongoing", wanted)
        if done:
            self._done = True
            self._tell("motion-done")

    def _tell(self, kind: str, *more: float) -> None:
        self._events.write(Bottle([kind, clock.now(), *more]))
