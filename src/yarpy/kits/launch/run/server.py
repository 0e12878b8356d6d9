"""The server that starts programs on this computer: C++ yarprun's port, and what keeps them.

    with RunServer("/nodeA"):
        ...                                  `yarpy run --on /nodeA --as cam --cmd "yarpdev ..."`

Rules: one thread listens to all programs, so a silent or a wild one costs no more than it must. A
program outlives its server unless `ends`; the next server of that name finds it again, with what it
has said meanwhile. Who may ask is decided by `permission`, what may be started by `allowed`. It
needs a system with sessions and pipes in the file system, so not Windows.
"""

from __future__ import annotations

import math
import os
import signal
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, Self

from yarpy import linger
from yarpy.data.bottle import Bottle
from yarpy.errors import AddressError, DecodeError, LocalProtocolError, YarpError
from yarpy.kits.launch.run import program as programs
from yarpy.kits.launch.run import request as requests
from yarpy.kits.launch.run.allowed import Allowed, located
from yarpy.kits.launch.run.command_line import variables_of, words_of
from yarpy.kits.launch.run.permission import RunGate
from yarpy.kits.launch.run.program import Program
from yarpy.kits.launch.run.relay import LogRelay, TerminalRelay
from yarpy.kits.launch.run.request import Request, aborted, started
from yarpy.kits.launch.run.state_folder import Entry, StateFolder
from yarpy.limit import RUN_PROGRAMS, RUN_REQUEST
from yarpy.link.begin.admission import Gate
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.platform.process import KILL
from yarpy.port.keep.log_sender import LOGGER
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.wire.message import Message

PERIOD: Final = 0.1  # seconds between looks at all programs
GRACE: Final = 3.0  # seconds that programs get to end, where they end with their server
ASKING: Final = 5.0  # seconds for the server of a terminal
TELLING: Final = 2.0  # seconds in which the last lines leave

log = logger("yarpy.run")


class RunServer:
    """Starts programs for those who may. log: the logger that all programs are told to, "" for
    none. ends: they end with the server. folder: of what it keeps (`state_folder`). on_exit: called
    when somebody asks the server to end. Raises AddressError, NoNameServer."""

    def __init__(
        self,
        name: str,
        *,
        allowed: Allowed | None = None,
        log: str = "",
        ends: bool = False,
        folder: str | Path | None = None,
        on_exit: Callable[[], None] = lambda: None,
        names: NameClient | None = None,
    ) -> None:
        if os.name != "posix":
            raise AddressError("yarpy run --server needs Linux, macOS or another Unix")
        self._name, self._names = name, names
        self._process = os.getpid()
        self._allowed = Allowed() if allowed is None else allowed
        self._log, self._ends, self._on_exit = log, ends, on_exit
        self._lock = threading.Lock()  # of the table; programs are started outside of it
        self._programs: list[Program] = []
        self._last: deque[Program] = deque(maxlen=20)  # of those that ended
        self._starting = 0
        self._count = 0
        self._closing = threading.Event()
        self._news = threading.Event()
        self._state = StateFolder(name, folder)
        try:
            self._port = RpcServer(
                name, self._answer, names=names, gate=self._gate, limit=RUN_REQUEST
            )
        except BaseException:
            self._state.close()
            raise
        self._find_again()
        with suppress(YarpError):  # servers of other systems keep no such notes
            if self._port._hub.names is not None:
                self._port._hub.names.set(name, "yarprun", "true")
        self._thread = threading.Thread(target=self._watch, name=f"programs of {name}", daemon=True)
        self._thread.start()
        linger.add(self, self.close)

    @property
    def name(self) -> str:
        """Return the name of its port."""
        return self._name

    @property
    def programs(self) -> list[Program]:
        """Return those that run."""
        with self._lock:
            return [*self._programs]

    def close(self, timeout: float | None = None) -> list[Program]:
        """Start nothing more; return the programs that go on.

        timeout: seconds that all of it may take; None: GRACE for programs that end with the server,
        TELLING for what they have said last. It may be called again, and goes on where Ctrl-C has
        cut it short.
        """
        if os.getpid() != self._process:
            return []  # a forked child has no programs: they are its parent's
        over = math.inf if timeout is None else time.monotonic() + timeout
        self._port.close(None if timeout is None else timeout / 4)
        if self._ends:
            self._end_all(min(time.monotonic() + GRACE, over))
        self._closing.set()
        self._news.set()
        self._thread.join()
        left = self.programs
        for one in left:
            one.leave()
        until = min(time.monotonic() + TELLING, over)
        for one in (*left, *self._last):
            for listener in one.listeners:
                listener.wait(until - time.monotonic())
        self._state.close()
        linger.remove(self)
        return left

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _gate(self, name: str) -> Gate:
        return RunGate(name, bool(self._allowed))

    # -- the watch --------------------------------------------------------------------------------

    def _find_again(self) -> None:
        for entry in self._state.entries():
            try:
                found = programs.found_again(self._state, entry)
            except OSError as error:
                log.warning("%s: %s is lost: %s", self._name, entry.tag, error)
                continue
            if found is None:
                log.info("%s: %s has ended meanwhile", self._name, entry.tag)
                self._state.remove(entry.id)
                continue
            log.info("%s: %s still runs as process %d", self._name, entry.tag, entry.pid)
            self._programs.append(found)
            self._listen(found)

    def _watch(self) -> None:
        while not self._closing.is_set():
            busy = False
            for one in self.programs:
                try:
                    busy = one.look() or busy
                    if one.ended():
                        self._forget(one)
                except Exception:
                    log.exception("%s: %s", self._name, one.entry.tag)
            if not busy:
                self._news.wait(PERIOD)

    def _forget(self, one: Program) -> None:
        with one.telling:  # who asks what it has said waits for the rest of it
            with self._lock:
                if one not in self._programs:
                    return  # two have seen that it is over
                self._programs.remove(one)
                self._last.append(one)
            one.finish()
        code = "" if one.code is None else f" with {one.code}"
        log.info("%s: %s ended%s", self._name, one.entry.tag, code)

    def _end_all(self, until: float) -> None:
        """Ask all to end, and make them at that time."""
        found = self.programs
        for one in found:
            one.process_tree.signal(signal.SIGTERM)
        while time.monotonic() < until and any(one.running for one in found):
            time.sleep(0.02)
        for one in found:
            while one.running:  # those who are just being started are new
                one.process_tree.signal(KILL)
                time.sleep(0.01)
        for one in found:
            self._forget(one)

    # -- requests ---------------------------------------------------------------------------------

    def _answer(self, message: Message) -> Any:
        try:
            request = requests.read(message.as_(Bottle))
        except DecodeError as error:
            return Bottle([-1, f"not understood: {error}\n"])
        tag = request.text(request.verb)
        match request.verb:
            case "stdio" if "stdiouuid" in request:
                return Bottle([-1, f"{self._name} opens no terminals\n"])
            case "stdio" | "cmd":
                return self._run(request)
            case "kill":
                return Bottle(["kill " + self._signal(tag, request.number("kill", 1))])
            case "sigterm":
                return Bottle(["sigterm " + self._signal(tag, signal.SIGTERM)])
            case "sigtermall":
                for one in self.programs:
                    one.process_tree.signal(signal.SIGTERM)
                return Bottle(["sigtermall OK"])
            case "ps":
                return Bottle(map(_shown, (one for one in self.programs if one.running)))
            case "isrunning":
                runs = any(one.running for one in self._tagged(tag))
                answer = Bottle(["running" if runs else "not running"])
                if "output" in request:
                    for one in self._tagged(tag):
                        if not one.running:  # the watch has not seen it yet
                            self._forget(one)
                    answer.append([line for one in self._heard(tag) for line in one.heard()])
                elif "code" in request and not runs:
                    answer += self._code(tag)
                return answer
            case "killstdio":
                return Bottle(["killstdio OK"])
            case "which":
                return Bottle([located(tag) if tag else ""])
            case "sysinfo":
                from yarpy.kits.launch.run.system import described

                return described()
            case "exit":
                threading.Thread(target=self._on_exit, name="exit", daemon=True).start()
                return Bottle(["exit OK"])
        known = ", ".join(requests.VERBS)
        return Bottle([-1, f"{self._name} does not understand that; it knows {known}\n"])

    def _tagged(self, tag: str) -> list[Program]:
        return [one for one in self.programs if one.entry.tag == tag]

    def _heard(self, tag: str) -> list[Program]:
        """Return the programs with that tag, those that ended last, too."""
        with self._lock:
            return [one for one in (*self._last, *self._programs) if one.entry.tag == tag]

    def _code(self, tag: str) -> list[int]:
        """Return the code of the last program with that tag that has ended, if it is known."""
        codes = [one.code for one in self._heard(tag) if one.code is not None]
        return codes[-1:]

    def _signal(self, tag: str, number: int) -> str:
        if not 0 < number < signal.NSIG:
            return "FAILED"
        sent = [one.process_tree.signal(number) for one in self._tagged(tag)]
        self._news.set()
        return "OK" if any(sent) else "FAILED"

    def _run(self, request: Request) -> Bottle:
        command = request.command
        tag = request.text("as")
        try:
            words = words_of(command)
            tag = tag or os.path.basename(words[0])
            found = self._start(request, words, command, tag)
        except (OSError, LocalProtocolError, YarpError) as error:
            why = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
            log.warning("%s: %s is not started: %s", self._name, tag or command, why)
            return aborted(self._name, tag, command, why)
        log.info("%s: %s started as process %d: %s", self._name, tag, found.entry.pid, command)
        entry = found.entry
        answer = started(self._name, tag, command, entry.pid, entry.uuid)
        terminal = request.text("stdio")
        if terminal and terminal != self._name:
            answer += self._ask_terminal(terminal, request, entry.uuid)
        return answer

    def _start(self, request: Request, words: list[str], command: str, tag: str) -> Program:
        variables = variables_of(request.text("env"))
        self._allowed.check(words, variables, self._name)
        with self._lock:
            if len(self._programs) + self._starting >= RUN_PROGRAMS:
                raise LocalProtocolError(f"{self._name} runs {RUN_PROGRAMS} programs already")
            self._starting += 1
            self._count += 1
            count = self._count
        try:
            logs = "log" in request or bool(self._log)
            label = variables.get("YARP_LOG_PROCESS_LABEL", "")
            shown = os.path.basename(words[0]) + (f"[{label}]" if label else "")
            entry = Entry(
                self._state.fresh(),
                tag,
                command,
                request.text("env"),
                request.text("workdir"),
                port=f"/log{self._name}/{shown}" if logs else "",
                logger=(request.text("log") or self._log or LOGGER) if logs else "",
                uuid=f"{self._name}/{os.getpid()}/{tag}-{count}" if "stdio" in request else "",
            )
            found = programs.start(
                self._state,
                entry,
                words,
                variables,
                path=self._allowed.path(words[0]),
                relays=logs or bool(entry.uuid),
            )
        finally:
            with self._lock:
                self._starting -= 1
        self._listen(found)
        with self._lock:
            self._programs.append(found)
        self._news.set()
        self._news.clear()
        return found

    def _listen(self, found: Program) -> None:
        """Tell on what a program says."""
        entry = found.entry
        if entry.port:
            found.listeners.append(LogRelay(entry.port, entry.logger, self._names))
        if entry.uuid:
            try:
                feed = programs.open_input(self._state, entry)
                relay = TerminalRelay(entry.uuid, feed, self._gate, self._names)
                found.listeners.append(relay)
            except (OSError, YarpError) as error:
                log.warning("%s: %s has no terminal: %s", self._name, entry.tag, error)

    def _ask_terminal(self, terminal: str, request: Request, uuid: str) -> list[object]:
        """Have another server open a terminal, as C++ does; return its answer."""
        groups = [Bottle([key, *words]) for key, words in request.groups.items()]
        try:
            with RpcClient[Any](terminal, names=self._names, timeout=ASKING) as client:
                return list(client.call(Bottle([*groups, Bottle(["stdiouuid", uuid])])))
        except YarpError as error:
            return [-1, f"no terminal at {terminal}: {error}\n"]


def _shown(one: Program) -> Bottle:
    entry = one.entry
    told = {
        "pid": entry.pid,
        "tag": entry.tag,
        "status": "running",
        "cmd": entry.command,
        "env": entry.environment,
    }
    return Bottle(Bottle([key, value]) for key, value in told.items())
