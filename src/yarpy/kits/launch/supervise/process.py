"""Processes as the system knows them: who belongs to a program, processor time, memory.

Rules: read from /proc, where there is one; elsewhere nothing is known but the process itself. What
belongs to a program is the session that it began and whatever has its mark in the environment, so
that neither a fork, nor another name, nor a session of its own hides a process. A process is told
from a later one with the same number by the moment of its start.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterable, Mapping, Set
from dataclasses import dataclass
from pathlib import Path
from typing import Final

MARK: Final = "YARPY_UP_PROGRAM"  # the variable that says which program a process is of
_PROC: Final = Path("/proc")
_LOOKS: Final = 6  # at all processes, while some of them end or begin
_PAUSE: Final = 0.004  # seconds until the second look at one that begins; twice that each time
_BEGINNING: Final = 2.0  # seconds in which a process gets its environment
_ENVIRON: Final = 1 << 18  # bytes that are looked at
_CHUNK: Final = 1 << 14  # ... of which most have less
_TICKS: Final = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100
_PAGE: Final = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


@dataclass(frozen=True, slots=True)
class Process:
    """A process: `start` in ticks since the system began, `seconds` of processors, `memory` in
    bytes."""

    pid: int
    parent: int
    session: int
    start: int
    state: str
    seconds: float
    memory: int

    @property
    def alive(self) -> bool:
        """Return whether it runs: a zombie does not."""
        return self.state not in "ZX"


def known() -> bool:
    """Return whether this system tells of all its processes. The /proc of wine is Linux's."""
    return os.name == "posix" and (_PROC / "self" / "stat").exists()


def look(pid: int) -> Process | None:
    """Return what the system knows of a process, None if there is none or it does not tell."""
    try:
        text = _read(f"/proc/{pid}/stat")
    except OSError:
        return None
    return parse(pid, text)


def parse(pid: int, text: bytes) -> Process | None:
    """Return what a line of /proc/PID/stat says; the name in it may have blanks and brackets."""
    words = text[text.rfind(b")") + 1 :].split()
    if len(words) < 22:
        return None
    return Process(
        pid=pid,
        parent=int(words[1]),
        session=int(words[3]),
        start=int(words[19]),
        state=words[0].decode(),
        seconds=(int(words[11]) + int(words[12])) / _TICKS,
        memory=int(words[21]) * _PAGE,
    )


def mark_of(pid: int) -> str | None:
    """Return the mark in the environment of a process, "" for none or that of another user, None
    while it has no environment: between two programs, or given none."""
    try:
        text = _read(f"/proc/{pid}/environ")
    except PermissionError:
        return ""
    except OSError:
        return None
    start = f"{MARK}=".encode()
    for entry in text.split(b"\0"):
        if entry.startswith(start):
            return entry[len(start) :].decode("utf-8", "replace")
    return "" if text else None


@dataclass(frozen=True, slots=True)
class Scan:
    """All processes at one moment: `found` has the session and the mark of each, `unclear` are
    those that ended meanwhile or had no environment."""

    found: Mapping[int, tuple[int, str]]
    unclear: Set[int]

    def members(self, sessions: Mapping[int, str], marks: Collection[str]) -> dict[int, str]:
        """Return the processes of programs, as `members` does."""
        named = (
            (pid, sessions.get(session) or mark) for pid, (session, mark) in self.found.items()
        )
        return {pid: mark for pid, mark in named if mark in marks}


def scan() -> Scan:
    """Look at all processes but this one; at none where there is no /proc."""
    return _looked(_pids(), {})


def rescan(before: Scan) -> Scan:
    """Look again, but not at processes whose session and mark are known: that would cost as much
    as the first look, and they keep both as long as they run this program."""
    pids = _pids()
    known = {pid: before.found[pid] for pid in pids if pid in before.found}
    fresh = [pid for pid in pids if pid not in known or pid in before.unclear]
    return _looked(fresh, known)


def _looked(pids: Iterable[int], known: Mapping[int, tuple[int, str]]) -> Scan:
    found = {**known}
    unclear: set[int] = set()
    own = os.getpid()
    for pid in pids:
        process = look(pid)
        if pid == own:
            continue
        mark = mark_of(pid) if process is not None and process.alive else None
        if process is not None and process.alive:
            found[pid] = process.session, mark or ""
        else:
            found.pop(pid, None)
        if mark is None:
            unclear.add(pid)
    return Scan(found, unclear)


def members(
    sessions: Mapping[int, str], marks: Collection[str], scan: Callable[[], Scan] = scan
) -> dict[int, str]:
    """Return the processes of programs, each with the mark of its program: those in `sessions`
    (by the number of the session), and those that have one of the `marks`. Not this process."""
    now = scan()
    for number in range(_LOOKS):
        found, before = now.members(sessions, marks), now.unclear
        if found or not before:
            return found
        # One that ended between the list of all and the look at it may have begun another one.
        now = rescan(now)
        if now.unclear <= before:
            if not any(map(_is_beginning, now.unclear)):
                break
            time.sleep(_PAUSE * 2**number)
    return now.members(sessions, marks)


def _is_beginning(pid: int) -> bool:
    """Return whether a process without an environment may be about to get one: it has just been
    started, and is no thread of the system."""
    process = look(pid)
    if process is None or not process.alive or not process.memory or sys.platform != "linux":
        return False
    return time.clock_gettime(time.CLOCK_BOOTTIME) - process.start / _TICKS < _BEGINNING


class Scanner:
    """Scans for many who ask at once: each gets one that began after it had asked."""

    def __init__(self) -> None:
        self._turn = threading.Condition()
        self._begun = 0
        self._done = 0
        self._busy = False
        self._last = Scan({}, frozenset())

    def scan(self) -> Scan:
        """Return a look at all processes that is no older than the question."""
        with self._turn:
            wanted = self._begun + 1
            while self._busy and self._done < wanted:
                self._turn.wait()
            if self._done >= wanted:
                return self._last
            self._busy = True
            self._begun += 1
            mine = self._begun
        try:
            found = scan()
        except BaseException:
            with self._turn:
                self._busy = False
                self._turn.notify_all()
            raise
        with self._turn:
            self._busy, self._done, self._last = False, mine, found
            self._turn.notify_all()
        return found


def _read(path: str) -> bytes:
    """Return what a file of /proc says, or as much as is looked at: without the buffers of `open`,
    which take most of the time where there are hundreds of files."""
    file = os.open(path, os.O_RDONLY)
    try:
        parts = [os.read(file, _CHUNK)]
        while len(parts[-1]) == _CHUNK and len(parts) * _CHUNK < _ENVIRON:
            parts.append(os.read(file, _CHUNK))
    finally:
        os.close(file)
    return parts[0] if len(parts) == 1 else b"".join(parts)


def _pids() -> list[int]:
    try:
        return [int(name) for name in os.listdir(_PROC) if name.isdigit()]
    except OSError:
        return []


def usage(sessions: Mapping[int, str]) -> dict[str, tuple[float, int]]:
    """Return the seconds of processors and the bytes of memory of all processes of each session,
    by the names in `sessions`."""
    found: dict[str, tuple[float, int]] = {}
    for pid in _pids():
        process = look(pid)
        if process is not None and process.session in sessions and process.alive:
            name = sessions[process.session]
            seconds, memory = found.get(name, (0.0, 0))
            found[name] = seconds + process.seconds, memory + process.memory
    return found
