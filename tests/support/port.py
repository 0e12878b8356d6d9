"""Free port numbers on the loopback, for servers that a test starts.

Rules: numbers come from below the kernel's range for outgoing connections, so that no outgoing
connection of another process takes one between the look and the bind; a number is handed out once
per process; a block is free for TCP and for UDP. Where tests run side by side (pytest-xdist) each
process has a part of the range for itself.
"""

import contextlib
import os
import random
import socket
from ipaddress import ip_address
from pathlib import Path

_LOWEST = 20_000
_HIGHEST = 32_000
_given: set[int] = set()


def free_port() -> int:
    """One port number that nobody uses, for TCP and for UDP."""
    return free_block(1)


def answers(port: int) -> bool:
    """Return whether somebody accepts connections there."""
    try:
        socket.create_connection(("127.0.0.1", port), 1).close()
    except OSError:
        return False
    return True


def free_block(size: int) -> int:
    """The first of `size` consecutive free port numbers (a name server hands out the others)."""
    for attempt in range(1000):
        if attempt == 500:
            _given.clear()  # a long run has had them all; what is still in use is not free
        lowest, highest = _range()
        first = random.randrange(lowest, highest - size)
        block = range(first, first + size)
        if _given.isdisjoint(block) and all(_is_free(number) for number in block):
            _given.update(block)
            return first
    raise OSError(f"no {size} consecutive free ports between {_LOWEST} and {_ceiling()}")


def addresses(pid: int, kind: str) -> list[str]:
    """The addresses at which a program listens, for connections with `tcp`, or has sockets of
    `udp`."""
    inodes = set()
    for descriptor in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # it was closed meanwhile
            inodes.add(os.readlink(descriptor).removeprefix("socket:[").rstrip("]"))
    rows = Path(f"/proc/{pid}/net/{kind}").read_text("ascii").splitlines()[1:]
    return [
        str(ip_address(bytes.fromhex(words[1].partition(":")[0])[::-1]))
        for words in map(str.split, rows)
        if words[9] in inodes and words[3] in ("0A", "07")
    ]


def _range() -> tuple[int, int]:
    """The numbers of this process: all, or one of as many parts as there are processes."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    size = (_ceiling() - _LOWEST) // int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    return _LOWEST + worker * size, _LOWEST + (worker + 1) * size


def _ceiling() -> int:
    """First number that outgoing connections may take; a fixed one where nobody tells."""
    try:
        lowest_outgoing = int(
            Path("/proc/sys/net/ipv4/ip_local_port_range").read_text(encoding="utf-8").split()[0]
        )
    except (OSError, ValueError, IndexError):
        return _HIGHEST
    # A host whose outgoing range covers everything leaves no better choice than luck.
    return lowest_outgoing if lowest_outgoing > _LOWEST + 2000 else _HIGHEST


def _is_free(number: int) -> bool:
    for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
        with socket.socket(socket.AF_INET, kind) as probe:
            if kind == socket.SOCK_STREAM:
                # What is left of closed connections is no obstacle to a listener.
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                # All addresses: a C++ server binds 0.0.0.0 whatever it is told.
                probe.bind(("", number))
            except OSError:
                return False
    return True
