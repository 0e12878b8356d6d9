"""Programs of this computer, as the system sees them: who listens, who is stopped, who runs short.

    Linux           all of it, from /proc, but for what other users own
    Windows         which process listens, and its program
    macOS           nothing

Rules: what is not known is nothing, and no error.
A number that a port gives is that of its own computer (or container): a listener is looked up by
its socket instead.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from yarpy.platform.listening import listening
from yarpy.platform.process import program

# wine shows that of Linux, whose numbers mean other processes
PROC: Final = Path("/proc" if sys.platform != "win32" else r"\\.\none")
_LISTEN: Final = "0A"
_OPEN: Final = "01"  # in others the end counts as a byte
_SOCKET = re.compile(r"socket:\[(\d+)\]")


@dataclass(frozen=True, slots=True)
class Socket:
    """A TCP socket: numbers of both ends (0: none), its state as the kernel writes it, and bytes
    that wait to be sent and to be read."""

    local: int
    remote: int
    state: str
    unsent: int
    unread: int
    inode: int

    @property
    def listens(self) -> bool:
        """True if it accepts connections."""
        return self.state == _LISTEN


def sockets() -> Iterator[Socket]:
    """Every TCP socket of this computer."""
    for name in ("tcp", "tcp6"):
        try:
            lines = (PROC / "net" / name).read_text().splitlines()[1:]
        except OSError:
            continue
        for line in lines:
            words = line.split()
            unsent, _, unread = words[4].partition(":")
            yield Socket(
                _port(words[1]), _port(words[2]), words[3], int(unsent, 16), int(unread, 16),
                int(words[9]),
            )  # fmt: skip
    for port in listening():
        yield Socket(port, 0, _LISTEN, 0, 0, 0)


def _port(address: str) -> int:
    return int(address.rpartition(":")[2], 16)


def listener(port: int) -> int:
    """The process that listens on a TCP port of this computer, 0 if none is known."""
    inodes = {one.inode for one in sockets() if one.listens and one.local == port}
    if not inodes:
        return 0
    if sys.platform == "win32":
        return listening().get(port, 0)
    for folder in PROC.glob("[0-9]*/fd"):
        try:
            names = os.listdir(folder)
        except OSError:
            continue  # it has ended, or belongs to somebody else
        for name in names:
            try:
                found = _SOCKET.fullmatch(os.readlink(folder / name))
            except OSError:
                continue  # closed meanwhile
            if found and int(found[1]) in inodes:
                return int(folder.parent.name)
    return 0


def unread(port: int) -> int:
    """Bytes that lie unread in the connections to a listening port of this computer."""
    return sum(one.unread for one in sockets() if one.local == port and one.state == _OPEN)


def state(pid: int) -> str:
    """The state of a process: R, S, D, T (stopped), t (traced), Z; "" if there is none."""
    try:
        return (PROC / str(pid) / "stat").read_text().rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return ""


def command(pid: int) -> str:
    """Its command line, as far as it is short; its program, where the system says no more."""
    try:
        words = (PROC / str(pid) / "cmdline").read_bytes().split(b"\0")
    except OSError:
        return program(pid)[-60:] if pid else ""
    return " ".join(b" ".join(words).decode("utf-8", "replace").split())[:60]


def limit(pid: int, name: str) -> int | None:
    """A soft limit of a process (`Max open files`), None if it has none or it is not known."""
    try:
        lines = (PROC / str(pid) / "limits").read_text().splitlines()
    except OSError:
        return None
    for line in lines:
        if line.startswith(name):
            word = line[len(name) :].split()[0]
            return int(word) if word.isdigit() else None
    return None


def open_files(pid: int) -> int | None:
    """Return the number of file descriptors that a process has open; None if nobody can say."""
    try:
        return len(os.listdir(PROC / str(pid) / "fd"))
    except OSError:
        return None


def setting(name: str) -> int | None:
    """A number of the kernel's settings, such as net/core/rmem_max."""
    try:
        return int((PROC / "sys" / name).read_text())
    except (OSError, ValueError):
        return None
