"""The helper of one connection through MPI: `python -m yarpy.peers.mpi.helper DATA LINE`.

    DATA   the number of a Unix socket to the program of the port (`meeting.py`)
    LINE   of the TCP connection on which the two have met

Rules: it ends with the connection, and with the program at the other end of DATA.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import threading
from typing import Final

from yarpy.errors import YarpError
from yarpy.peers.mpi.bcast import BcastReader, End, open_end
from yarpy.peers.mpi.meeting import LEAVE

PIECE: Final = 1 << 18  # bytes that are handed on at once


def main(data: int, line: int) -> None:
    """Meet the peer, and hand on what comes from either side until one has gone."""
    with socket.socket(fileno=data) as own, socket.socket(fileno=line) as met:
        _serve(own, met)


def _serve(own: socket.socket, met: socket.socket) -> None:
    with own.makefile("rb") as file:
        told = json.loads(file.readline())
    try:
        end = open_end(told["kind"], True, met, told["pair"])
        met.close()
        end.place = told["place"]
        end.ready()
    except (YarpError, OSError) as error:
        own.sendall(f"{' '.join(str(error).split())}\n".encode()[-900:])
        return
    own.sendall(b"ok\n")
    threading.Thread(target=_receive, args=(end, own), daemon=True).start()
    _send(own, end)


def _receive(end: End, own: socket.socket) -> None:
    """Pass what the peer sends to the program."""
    view = memoryview(bytearray(PIECE))
    try:
        while count := end.recv_into(view):
            own.sendall(view[:count])
    except OSError:
        pass
    try:
        own.shutdown(socket.SHUT_WR)
    except OSError:
        pass


def _send(own: socket.socket, end: End) -> None:
    """Pass what the program sends to the peer, until the program closes the connection."""
    reader = end if isinstance(end, BcastReader) else None
    last = b""
    try:
        while piece := own.recv(PIECE):
            last = piece
            if reader is None:
                end.send([piece])
    except OSError:
        pass
    if reader is not None and last != LEAVE:
        os._exit(1)  # the program has died: so has this reader
    end.close()
    if reader is not None:
        reader.wait_left()


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
    os._exit(0)  # whatever threads of MPI still do
