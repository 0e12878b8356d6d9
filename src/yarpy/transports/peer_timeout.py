"""Peers that die without a word: how long a TCP connection outlives a host that is switched off or
cut off. `YARPY_PEER_TIMEOUT`, in seconds, in the environment of the program; 0: hours. For one
connection `+peer_timeout.60` behind its carrier, which counts at both of its ends.

Rules: the kernel notices, for both sides: keepalive where nothing is on its way, TCP_USER_TIMEOUT
where something is. That option ends a connection to a reader that takes nothing for so long, too,
although its host lives (RFC 5482 leaves this open; Linux does it): a strict writer has to wait for
such a reader, so a ZeroWindowTimeout looks after it in place of the kernel. Not every system has
all of this.
"""

from __future__ import annotations

import os
import socket
import sys
from contextlib import suppress
from functools import lru_cache
from typing import Final

from yarpy.log import logger
from yarpy.transports.tcp_info import tcp_info

log = logger("yarpy.transports")

SETTING: Final = "YARPY_PEER_TIMEOUT"
DEFAULT: Final = 25.0  # seconds
PARAMETER: Final = "peer_timeout"  # of a carrier
LONGEST: Final = 86_400  # seconds that it may say, since a stranger may

_RTO_MAX: Final = 44  # TCP_RTO_MAX_MS, since Linux 6.15


def peer_timeout() -> float:
    """Seconds without an answer after which a host is taken for dead; 0: never."""
    return _seconds(os.environ.get(SETTING, "").strip())


@lru_cache(maxsize=8)
def _seconds(said: str) -> float:
    try:
        seconds = float(said) if said else DEFAULT
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds < 1e6:
        log.warning("%s=%s is no number of seconds; it is taken for %g", SETTING, said, DEFAULT)
        return DEFAULT
    return seconds


def asked_timeout(said: str) -> int:
    """The seconds that a connection asks for itself. Raises ValueError."""
    if said.isascii() and said.isdigit() and len(said) < 9 and 1 <= int(said) <= LONGEST:
        return int(said)
    raise ValueError(
        f"{PARAMETER}.{said[:40]}: write a whole number of seconds from 1 to {LONGEST}, as in "
        f"tcp+{PARAMETER}.60"
    )


def notice_death(sock: socket.socket, timeout: float | None = None) -> None:
    """Let the kernel end the TCP connection of `sock` when the peer's host is dead: when nothing
    comes from there for `timeout` seconds; None: as the environment says."""
    timeout = peer_timeout() if timeout is None else timeout
    if not timeout:
        return
    # After a while of silence it asks three times.
    pause = max(1, round(timeout / 5))
    settings = {
        "TCP_KEEPIDLE": max(1, round(timeout) - 3 * pause),
        "TCP_KEEPINTVL": pause,
        "TCP_KEEPCNT": 3,
        "TCP_USER_TIMEOUT": round(1000 * timeout),
    }
    try:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        for name, value in settings.items():
            if hasattr(socket, name):
                sock.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
        if sys.platform == "linux":  # the pauses between two attempts grow up to this
            sock.setsockopt(socket.IPPROTO_TCP, _RTO_MAX, 1000 * pause)
    except OSError:
        pass  # the peer has gone already, as the first use tells


class ZeroWindowTimeout:
    """Looks after the connection to a reader that takes nothing, now and then.

    While everything that was sent is acknowledged and more waits, the reader's window is closed,
    and the kernel asks for it from time to time; its host lives as long as that is answered.
    `timeout` is that of the connection; None: as the environment says.
    """

    def __init__(self, timeout: float | None = None) -> None:
        self._timeout = timeout
        self._spared = False  # TCP_USER_TIMEOUT is off

    def expired(self, sock: socket.socket) -> bool:
        """Return whether the host of a reader that takes nothing does not answer either."""
        if sys.platform != "linux":
            return False
        info = tcp_info(sock)
        timeout = peer_timeout() if self._timeout is None else self._timeout
        if info is None or not timeout:
            return False
        closed = not info.on_the_way and info.unsent > 0
        if closed != self._spared:
            limit = 0 if closed else round(1000 * timeout)
            with suppress(OSError):  # closed meanwhile
                sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, limit)
            self._spared = closed
        return closed and info.unanswered > 1 and info.silence > 1000 * timeout
