"""A program of a server, from its start, or from where a server that is gone has left it.

Rules: it runs in a session of its own, reads from a pipe in the file system that never ends, or
from nothing, and writes to a file; so it needs nobody. What it says is told on by `look`, which its
server calls again and again. It has ended when no process of its tree lives.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final, Protocol

from yarpy.kits.launch.run import process_tree
from yarpy.kits.launch.run.output import Output
from yarpy.kits.launch.run.process_tree import ProcessTree
from yarpy.kits.launch.run.state_folder import Entry, StateFolder
from yarpy.limit import RUN_KEPT

ORPHANS: Final = 0.5  # seconds between looks for those that a program has left behind
#: What a server's own environment has for itself.
_OWN: Final = ("YARPY_BIND", "YARP_FORWARD_LOG_ENABLE")


class Listener(Protocol):
    """Somebody who hears what a program says."""

    def hear(self, lines: Sequence[str]) -> None:
        """Take lines, without their ends."""

    def close(self) -> None:
        """Take no more. Waits for nobody."""

    def wait(self, seconds: float) -> None:
        """Wait for so long, at most, until all was told on."""


class Program:
    """A program that was started. `entry` says what; `code` is what it ended with, minus the
    number of a signal, None while it runs and where it was somebody else's child."""

    def __init__(
        self, state: StateFolder, entry: Entry, child: subprocess.Popen[bytes] | None = None
    ) -> None:
        self.entry = entry
        self.process_tree = ProcessTree(entry.pid, entry.id, entry.began)
        self.code: int | None = None
        self.kept: deque[str] = deque(maxlen=RUN_KEPT)
        self.listeners: list[Listener] = []
        self._state, self._child = state, child
        self._place = state.place(entry.id)
        self._output = Output(state.path(entry.id, "out"), self._place)
        self._looked = 0.0
        self._orphaned = True  # whether somebody lived without the first process, the last time
        self._told = 0
        self._finished = False
        #: Of its output: held while lines are told, and by who forgets it until the last are.
        self.telling = threading.RLock()

    def reap(self) -> bool:
        """Return whether the first process lives; one that has ended is no zombie any more."""
        if self._child is None:
            return self.process_tree.leads
        code = self._child.poll()
        if code is not None:  # None is also for who asks while another thread does
            self.code = code
        return self.code is None

    @property
    def running(self) -> bool:
        """Return whether any process of its tree lives."""
        return self.reap() or bool(self.process_tree.members())

    def look(self) -> bool:
        """Tell what came, and return whether there may be more at once."""
        with self.telling:
            if self._finished:
                return False
            lines = self._output.read()
            lost = self._output.lost
            if lost > self._told:
                lines.insert(0, _lost(lost - self._told))
                self._told = lost
            self._tell(lines)
            return bool(lines)

    def heard(self) -> list[str]:
        """Return what it said last, behind how much is missing of what it said."""
        with self.telling:
            lost = self._output.lost
            return [*([_lost(lost)] if lost else []), *self.kept]

    def ended(self) -> bool:
        """Return whether nobody lives, as seldom as is soon enough."""
        if self.reap():
            return False
        now = time.monotonic()
        if self._orphaned and now - self._looked < ORPHANS and self._looked:
            return False
        self._looked = now
        self._orphaned = bool(self.process_tree.members())
        return not self._orphaned

    def finish(self) -> None:
        """Tell the rest of a program that has ended, and forget it."""
        with self.telling:
            while self.look():
                pass
            self._tell(self._output.read(whole=True))
            self.leave()
            self._finished = True
        self._state.remove(self.entry.id)

    def leave(self) -> None:
        """Hear no more of it; it goes on."""
        for listener in self.listeners:
            listener.close()
        self._output.close()
        if self._child is not None and self._child.returncode is None:
            self._child.returncode = 0  # it is not ours to wait for any more

    def _tell(self, lines: list[str]) -> None:
        if lines:
            self.kept.extend(lines)
            for listener in self.listeners:
                listener.hear(lines)
        place = self._output.read_so_far
        if place != self._place:
            self._place = place
            self._state.set_place(self.entry.id, place)


def _lost(count: int) -> str:
    return f"[yarpy run] {count} bytes before this came too fast and are lost"


def start(
    state: StateFolder,
    entry: Entry,
    words: Sequence[str],
    variables: Mapping[str, str],
    *,
    path: str | None = None,
    relays: bool = False,
) -> Program:
    """Start a program, which gets what its entry has not yet. path: the file, where the name must
    not choose. relays: somebody tells on what it says. Raises OSError."""
    environment = {key: value for key, value in os.environ.items() if key not in _OWN}
    environment |= {"YARP_IS_YARPRUN": "1", "YARPRUN_IS_FORWARDING_LOG": "1" if relays else "0"}
    environment |= {**variables, process_tree.MARK: entry.id}
    folder = entry.workdir or None
    if folder is not None and not Path(folder).is_dir():
        raise NotADirectoryError(f"cannot set working directory {folder}")
    file = path or _file(words[0], folder, environment)
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND
    out = os.open(state.path(entry.id, "out"), flags, 0o600)
    feed = -1
    try:
        feed = open_input(state, entry) if entry.uuid else os.open(os.devnull, os.O_RDONLY)
        state.write(entry)
        child = subprocess.Popen(
            [words[0], *words[1:]],
            executable=file,
            cwd=folder,
            env=environment,
            stdin=feed,
            stdout=out,
            stderr=out,
            start_new_session=True,
        )
    except BaseException:
        state.remove(entry.id)
        raise
    finally:
        os.close(out)
        if feed >= 0:
            os.close(feed)
    entry = replace(entry, pid=child.pid, began=process_tree.began(child.pid))
    if entry.port:
        entry = replace(entry, port=f"{entry.port}/{child.pid}")
    with suppress(OSError):  # a full disk: it runs, and is lost with this server
        state.write(entry)
    return Program(state, entry, child)


def open_input(state: StateFolder, entry: Entry) -> int:
    """Open the input of a program, for both ends: then none of them ever sees an end of it. Raises
    OSError."""
    pipe = state.path(entry.id, "in")
    if sys.platform == "win32":
        raise OSError("Windows has no pipes in the file system")
    with suppress(FileExistsError):
        os.mkfifo(pipe, 0o600)
    return os.open(pipe, os.O_RDWR)


def _file(name: str, folder: str | None, environment: Mapping[str, str]) -> str:
    """Return the file of a program: in its folder, else on the PATH. Raises FileNotFoundError."""
    here = Path(folder or ".", name)
    if here.is_file() and os.access(here, os.X_OK):
        return str(here.absolute())
    found = shutil.which(name, path=environment.get("PATH"))
    if found is None:
        raise FileNotFoundError(f"there is no program {name} there, or it may not be executed")
    return found


def found_again(state: StateFolder, entry: Entry) -> Program | None:
    """Return a program that another server has started, None if it has ended."""
    if not entry.pid:
        pid = process_tree.leader(entry.id)
        port = f"{entry.port}/{pid}" if entry.port else ""
        entry = replace(entry, pid=pid, began=process_tree.began(pid) if pid else 0, port=port)
        if not pid:
            return None
        state.write(entry)
    if not ProcessTree(entry.pid, entry.id, entry.began).members():
        return None
    return Program(state, entry)
