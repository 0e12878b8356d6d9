"""The system's knowledge of a TCP connection.

Rules: Linux alone tells, in its struct tcp_info; elsewhere there is nothing to know.
"""

from __future__ import annotations

import socket
import struct
import sys
from typing import Final, NamedTuple

_OPTION: Final = getattr(socket, "TCP_INFO", None) if sys.platform == "linux" else None
# tcpi_probes, tcpi_unacked, tcpi_last_ack_recv, tcpi_bytes_acked, tcpi_bytes_received,
# tcpi_notsent_bytes
_LAYOUT: Final = struct.Struct("=3xB20xI28xI60x2Q8xI")


class TcpInfo(NamedTuple):
    """unanswered: questions for room at the peer, in a row, to which nothing came. on_the_way:
    packets that are not acknowledged. silence: milliseconds since the last acknowledgement.
    confirmed: bytes that the peer's system has taken. came: bytes that came here. unsent: bytes
    that wait here for room at the peer."""

    unanswered: int
    on_the_way: int
    silence: int
    confirmed: int
    came: int
    unsent: int


def tcp_info(sock: socket.socket) -> TcpInfo | None:
    """Return what the kernel knows of the connection of `sock`; None if it tells nothing."""
    if _OPTION is None:
        return None
    try:
        told = sock.getsockopt(socket.IPPROTO_TCP, _OPTION, _LAYOUT.size)
    except OSError:
        return None
    return TcpInfo(*_LAYOUT.unpack(told)) if len(told) == _LAYOUT.size else None
