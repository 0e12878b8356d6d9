"""Module: a program that is configured, does something again and again, and can be asked to end.

    class Tracker(Module):
        name = "/tracker"
        period = 0.02
        commands = {"status": "tell how many were seen"}

        def configure(self, resources):
            self.seen = 0
            self.camera = yarpy.BufferedPort(self.name + "/image:i")

        def update(self):
            ...

        def respond(self, request):
            if request == ["status"]:
                return [self.seen]

        def close(self):
            self.camera.close()

    sys.exit(Tracker().run(ResourceFinder(sys.argv[1:])))

Rules. `configure` runs first, `close` last, whatever happens between them, except where `configure`
returned False or raised. A module with a name opens `NAME/rpc`, which answers what `respond`
returns, and knows `help` and `quit`; and `NAME/quit`, by which `yarpy terminate NAME` ends it.
SIGINT and SIGTERM, on Windows Ctrl-Break, end it in good order; the fourth of them ends the process
at once. `update` is called every `period` seconds by `yarpy.clock`, and what one call takes too
long is not caught up.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from types import FrameType
from typing import Any, Final, Self

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, PortClosed
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcServer
from yarpy.resource import ResourceFinder
from yarpy.threads import Thread
from yarpy.wire.message import Message

log = logger("yarpy.module")

#: The words that end a module; a vocab holds their first four letters.
QUIT: Final = frozenset(("quit", "exit", "bye"))
#: Signals after which the process no longer waits for the module to end.
SIGNALS: Final = 3
#: Signals that end a module; that of Ctrl-Break is how a program of Windows is asked to.
ENDING: Final = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name)
)


class Module:
    """Subclasses define some of `configure`, `update`, `respond`, `interrupt` and `close`."""

    #: what its ports are called after; `--name` changes it, "" opens none
    name: str = ""
    #: seconds from one update to the next; may be a property
    period: float = 1.0
    #: what `help` tells of the commands that `respond` knows
    commands: Mapping[str, str] = {}

    _ending: threading.Event
    _working: bool
    _lock: threading.RLock  # `interrupt` comes between `configure` and `close` only

    def __new__(cls, *args: object, **values: object) -> Self:
        # Not in __init__, so that a subclass need not call that of this class.
        self = super().__new__(cls)
        self._ending = threading.Event()
        self._working = False
        self._lock = threading.RLock()  # taken again where `interrupt` calls `stop`
        return self

    def configure(self, resources: ResourceFinder) -> bool | None:
        """Open ports, read options. False: give up, `run` returns 1."""
        return None

    def update(self) -> bool | None:
        """One step of the work. False: the module is done."""
        return None

    def respond(self, request: Bottle) -> object:
        """The answer to a request at `NAME/rpc`; None for one that is not known.

        Called from threads of connections, one at a time.
        """
        return None

    def interrupt(self) -> None:
        """Stop what `update` may be waiting for; called from another thread when it is to end."""

    def close(self) -> None:
        """Close ports, release what `configure` took."""

    @property
    def stopping(self) -> bool:
        """Return whether the module was asked to end."""
        return self._ending.is_set()

    def stop(self) -> None:
        """Ask it to end; `run` returns after the update that is under way."""
        with self._lock:
            self._ending.set()
            if self._working:
                self.interrupt()

    def run(
        self, resources: ResourceFinder | None = None, *, names: NameClient | None = None
    ) -> int:
        """Configure, update until something ends it, close; the exit code of the program.

        In the main thread signals are handled meanwhile. What the module raises is passed on, after
        `close`. Raises AddressError (a name is in use), NoNameServer.
        """
        resources = ResourceFinder() if resources is None else resources
        if isinstance(resources, (str, list, tuple)):
            raise TypeError("options are looked for: run(yarpy.ResourceFinder(sys.argv[1:]))")
        self.name = plain_text(resources.find("name") or self.name)
        with _signals(self.stop):
            if self.configure(resources) is False:
                log.error(
                    "%s gives up: it could not be configured", self.name or type(self).__name__
                )
                return 1
            with ExitStack() as ports:
                ports.callback(self.close)
                ports.enter_context(self._interruptible())
                if self.name:
                    for part, answer in (("rpc", self._answer), ("quit", self._quit)):
                        port = RpcServer(f"{self.name}/{part}", answer, names=names, lock=True)
                        ports.enter_context(port)
                self._loop()
        return 0

    def answer(self, request: Bottle) -> Any:
        """The answer of `respond`, or that of every module: help, quit, what is unknown."""
        found = self.respond(request)
        if found is not None:
            return found
        word = plain_text(request[0]) if request else ""
        if word in QUIT:
            # From another thread, since the answer is still to leave.
            Thread(target=self.stop, name="yarpy module stop", daemon=True).start()
            return Bottle([Vocab("bye")])
        if word == "help":
            known = {**self.commands, "help": "tell the commands", "quit": "end the module"}
            return Bottle([Vocab("many"), *(f"{key}: {text}" for key, text in known.items())])
        return Bottle([Vocab("fail"), f"unknown command {request.to_text()}: try help"])

    def _answer(self, message: Message) -> Any:
        try:
            request = message.as_(Bottle)
        except DecodeError as error:
            return Bottle([Vocab("fail"), str(error)])
        return self.answer(request)

    def _quit(self, message: Message) -> Any:
        request = message.as_(Bottle)
        if request and plain_text(request[0]) in QUIT:
            Thread(target=self.stop, name="yarpy module stop", daemon=True).start()
            return Bottle([Vocab("ok")])
        return Bottle([Vocab("fail"), "say quit"])

    @contextmanager
    def _interruptible(self) -> Iterator[None]:
        with self._lock:
            self._working = True
        try:
            yield
        finally:
            with self._lock:
                self._working = False

    def _loop(self) -> None:
        time = clock.current()
        while not self.stopping:
            begun = time.monotonic()
            try:
                if self.update() is False:
                    break
            except PortClosed:
                if not self.stopping:
                    raise
            time.wait(self._ending, begun + self.period - time.monotonic())


@contextmanager
def _signals(stop: Callable[[], None]) -> Iterator[None]:
    """Signals call `stop` in a thread of its own: this one may hold any lock when they come."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    count = 0

    def handle(number: int, frame: FrameType | None) -> None:
        nonlocal count
        count += 1
        if count > SIGNALS:
            os._exit(128 + number)
        Thread(target=stop, name="yarpy module stop", daemon=True).start()

    before = {number: signal.signal(number, handle) for number in ENDING}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
