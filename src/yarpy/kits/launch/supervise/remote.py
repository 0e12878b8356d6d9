"""Programs on other computers, through the server there: `yarpy run --server`, or C++ yarprun.

Rules: one thread for each server asks what runs there, four times a second; a server that does not
answer makes its programs `unknown`, not ended. Output comes to a port of each program, as logs of
yarprun do. A program runs there under a tag made of the names of the application and its own, so
one that an `up` that was killed has left is found, and not started twice. C++ yarprun never says
how a program has ended: that counts as a failure.
"""

from __future__ import annotations

import re
import signal
import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.supervise.runner import Program
from yarpy.limit import OUTPUT_LINE
from yarpy.names.base import NameClient
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import Port
from yarpy.wire.message import Message

PERIOD: Final = 0.25  # seconds between looks at what runs there
AGAIN: Final = 1.0  # ... while the server does not answer
ANSWER: Final = 3.0  # seconds that an answer may take
STARTING: Final = 10.0  # ... that of a start
_KILL: Final = 9  # what SIGKILL is there; this computer may have none
_TELLING: Final = 5.0  # seconds until the server has told what was written before the end
_ABANDONED: Final = 300.0  # seconds in which a program that may have been started is looked for

Line = Callable[[str], None]
End = Callable[[int | None], None]


def tag_of(application: str, name: str) -> str:
    """Return what a program of an application is called at its server."""
    return re.sub(r"[\s/]", "_", f"{application}:{name}")


class RemoteRunner:
    """Starts programs of the application `application` at the server called `server`.

    `grace` is how long one may take to end; `replace` ends what an earlier `up` has left there.
    Close it: it asks the server until then.
    """

    def __init__(
        self,
        server: str,
        application: str,
        *,
        grace: float,
        replace: bool = False,
        names: NameClient | None = None,
    ) -> None:
        self.server = server
        self.grace = grace
        self._application = application
        self._replace = replace
        self._names = names
        self._lock = threading.Lock()  # of the table of handles
        self._handles: dict[str, RemoteHandle] = {}
        self._abandoned: dict[str, tuple[threading.Thread, threading.Event]] = {}
        self._wake = threading.Event()
        self.closing = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> RemoteRunner:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def close(self) -> None:
        """Ask the server nothing any more. Programs that still run there go on, and whatever they
        print is lost."""
        self.closing.set()
        self._wake.set()
        with self._lock:
            handles = [*self._handles.values()]
            thread = self._thread
        for handle in handles:
            handle.port.close(0.0)
        for _, taken in [*self._abandoned.values()]:
            taken.set()
        if thread is not None:
            thread.join(ANSWER)

    def tag(self, name: str) -> str:
        """Return what a program is called there."""
        return tag_of(self._application, name)

    def start(self, program: Program, on_line: Line, on_end: End) -> RemoteHandle:
        """Start a program. Raises a YarpError that says why it is not."""
        tag = self.tag(program.name)
        doubtful = self._take_back(tag)
        handle = RemoteHandle(self, tag, on_line, on_end, self._names)
        try:
            with self.client(STARTING) as node:
                self._clear(node, tag, self._replace or doubtful)
                doubtful = True  # until it is answered
                started = node.start(
                    tag,
                    program.command,
                    workdir=program.workdir,
                    environment=program.environment,
                    log=handle.port.name,
                    stdio=program.stdio,
                )
        except BaseException as error:
            handle.port.close(0.0)
            if doubtful and isinstance(error, TimeoutError | ConnectionError):
                self._abandon(tag)
            raise
        handle.pid = started.pid
        with self._lock:
            self._handles[tag] = handle
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._watch, name=f"yarpy programs at {self.server}", daemon=True
                )
                self._thread.start()
        self._wake.set()
        return handle

    @property
    def doubtful(self) -> list[str]:
        """Tags of programs that may have been started, which no server has said yet."""
        return [tag for tag, (thread, _) in [*self._abandoned.items()] if thread.is_alive()]

    def client(self, timeout: float = ANSWER) -> RunClient:
        """Return a client of the server."""
        return RunClient(self.server, timeout=timeout, names=self._names)

    def _clear(self, node: RunClient, tag: str, replace: bool) -> None:
        """See that nothing runs under a tag, which `replace` ends. Raises LocalProtocolError if
        something does."""
        if not node.is_running(tag):
            return
        if replace:
            until = time.monotonic() + self.grace
            node.signal(tag, signal.SIGTERM)
            while node.is_running(tag):
                if time.monotonic() > until:
                    node.signal(tag, _KILL)
                time.sleep(PERIOD)
            return
        raise LocalProtocolError(
            f"{tag} runs at {self.server} already: --replace ends it, and so does "
            f"`yarpy run --on {self.server} --sigterm {tag}`"
        )

    def _abandon(self, tag: str) -> None:
        """End a program whose start was never answered, as soon as its server answers again, or
        whoever starts it again does."""
        taken = threading.Event()

        def follow() -> None:
            until = time.monotonic() + _ABANDONED
            while time.monotonic() < until and not (self.closing.is_set() or taken.is_set()):
                try:
                    with self.client() as node:
                        if node.is_running(tag):
                            node.signal(tag, _KILL)
                        return
                except YarpError:
                    taken.wait(AGAIN)

        thread = threading.Thread(target=follow, name=f"yarpy abandons {tag}", daemon=True)
        self._abandoned[tag] = thread, taken
        thread.start()

    def _take_back(self, tag: str) -> bool:
        """Return whether a start of before was never answered, and leave what came of it to the
        next one."""
        if tag not in self._abandoned:
            return False
        thread, taken = self._abandoned.pop(tag)
        taken.set()
        thread.join()  # it may be about to end what runs, which must not be the next one
        return True

    def _watch(self) -> None:
        """Look at the programs until none is left, and again when there are new ones."""
        while not self.closing.is_set():
            with self._lock:
                handles = dict(self._handles)
            if not handles:
                self._wake.wait()
                self._wake.clear()
                continue
            try:
                with self.client() as node:
                    while handles:
                        self._look(node, handles)
                        if self.closing.wait(PERIOD):
                            return
                        with self._lock:
                            handles = dict(self._handles)
            except YarpError as error:
                for handle in handles.values():
                    handle.lose(str(error))
                self.closing.wait(AGAIN)

    def _look(self, node: RunClient, handles: dict[str, RemoteHandle]) -> None:
        there = {one.tag for one in node.running()}
        for tag, handle in handles.items():
            if tag in there:
                handle.found()
                continue
            runs, code = node.ending(tag)
            if not runs:
                with self._lock:
                    self._handles.pop(tag, None)
                handle.finish(code)


class RemoteHandle:
    """A program that runs at a server."""

    def __init__(
        self,
        runner: RemoteRunner,
        tag: str,
        on_line: Line,
        on_end: End,
        names: NameClient | None,
    ) -> None:
        self.pid = 0
        self.detail = ""
        """The reason why its server does not answer, "" if it does."""
        self._runner = runner
        self._tag = tag
        self._on_line = on_line
        self._on_end = on_end
        self._code: int | None = None
        self._asked = False
        self._ended = threading.Event()
        self._told = threading.Lock()  # no line comes after the end
        self._over = False
        self._all_said = threading.Event()  # whoever tells what it says has gone
        name = f"/up{runner.server}/{tag}/{time.monotonic_ns()}"
        self.port: Port = Port(
            name, callback=self._hear, on_connection=self._see_connection, names=names
        )

    @property
    def state(self) -> str:
        """`running`, `ended`, or `unknown` while its server does not answer."""
        return "ended" if self._ended.is_set() else "unknown" if self.detail else "running"

    @property
    def returncode(self) -> int | None:
        """The exit code, or minus the number of a signal; None while it runs, or if nobody says."""
        return self._code if self._ended.is_set() else None

    def terminate(self, number: int = signal.SIGTERM) -> None:
        """Have the server send a signal, and after a while SIGKILL if the program is to end."""
        if not self._ended.is_set():
            threading.Thread(
                target=self._terminate, args=(number,), name=f"yarpy ends {self._tag}", daemon=True
            ).start()

    def wait(self, timeout: float | None = None) -> int | None:
        """Return what it ended with, None if it still runs after `timeout` seconds."""
        self._ended.wait(timeout)
        return self.returncode

    def found(self) -> None:
        """Note that it runs, and its server answers."""
        self.detail = ""

    def lose(self, why: str) -> None:
        """Note that its server does not answer."""
        self._all_said.clear()  # the next server tells what it says from then on
        self.detail = f"{self._runner.server} does not answer: {why}"

    def finish(self, code: int | None) -> None:
        """Note that it has ended, once its last lines are here."""
        threading.Thread(
            target=self._finish, args=(code,), name=f"yarpy end {self._tag}", daemon=True
        ).start()

    def _finish(self, code: int | None) -> None:
        # Its server connects beside the start, and may do so only now if it ended at once.
        self._all_said.wait(_TELLING)
        self.port.close(0.0)
        with self._told:
            self._over = True
        self._code = -int(signal.SIGTERM) if code is None and self._asked else code
        self._ended.set()
        self._on_end(self._code)

    def _terminate(self, number: int) -> None:
        ends = number in (signal.SIGTERM, signal.SIGINT)
        self._asked = self._asked or ends or number == _KILL
        self._send(number)
        if ends and not self._ended.wait(self._runner.grace):
            self._send(_KILL)

    def _send(self, number: int) -> None:
        """Send a signal, as soon as the server answers."""
        while not (self._ended.is_set() or self._runner.closing.is_set()):
            try:
                with self._runner.client() as node:
                    node.signal(self._tag, number)
                return
            except YarpError as error:
                self.lose(str(error))
                self._ended.wait(AGAIN)

    def _see_connection(self, event: ConnectionEvent) -> None:
        if event.incoming and not event.created:
            self._all_said.set()

    def _hear(self, message: Message) -> None:
        words = message.as_(Bottle)
        if len(words) != 2:
            return
        for line in plain_text(words[1]).removesuffix("\n").split("\n"):
            with self._told:
                if not self._over:
                    self._on_line(line[:OUTPUT_LINE])
