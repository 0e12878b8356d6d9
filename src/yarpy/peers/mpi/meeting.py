"""Meeting: the end of a connection whose peer has dialled us, kept at arm's length in a helper.

    us                                   the helper, a process of its own
    Unix socket: a line of JSON     ->   meets the peer in MPI, at the place that the peer has told
                                    <-   "ok", or why not: a line
    what is sent                    ->   what the peer gets by MPI
    what is received                <-   what the peer has sent by MPI

Rules: MPI believes the place that it connects to; a wrong one ends its process, and nothing inside
can prevent that. So that process is the helper, and its end is the end of one connection. Strangers
can have helpers started: so MOST meet at a time, and the next one is told to come again.
"""

from __future__ import annotations

import importlib.util
import json
import os
import platform
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.log import readable
from yarpy.peers.mpi.end import MEETING
from yarpy.peers.mpi.library import HINT, SETTING, permit
from yarpy.transports.base import Address
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire.framing import encode_refusal

MOST: Final = 2  # helpers that meet somebody at a time
PENALTY: Final = 1.0  # seconds more for a meeting in vain: starting a helper costs work
STARTING: Final = 10.0  # seconds for the helper to begin MPI
LEAVE: Final = b"q"  # to the helper of a reader of bcast: the port lets the connection go
_LINE: Final = 1000  # bytes that a helper says
# What a program that `mpiexec` has started must not hand on to one that it starts itself.
_STARTED: Final = ("PMI_", "PMIX_", "HYDI", "HYDRA_", "OMPI_COMM_WORLD_", "MPI_LOCALN")

_slots = threading.BoundedSemaphore(MOST)


class Meeting(SocketTransport):
    """Our end; connected once `ready` has returned. `place`: where MPI finds the peer, set by the
    carrier."""

    def __init__(self, kind: str, sock: socket.socket, pair: str) -> None:
        permit()
        if importlib.util.find_spec("mpi4py") is None:
            raise LocalProtocolError(f'{kind} needs mpi4py: `pip install "yarpy[mpi]"`')
        near, self._far = socket.socketpair()
        super().__init__(near)
        self._sock = sock.dup()
        self._kind, self._pair = kind, pair
        self._local: Address = sock.getsockname()[:2]
        self._remote: Address = sock.getpeername()[:2]
        # As C++ has it, to find out whether two ports are of one program.
        self.program = f"{platform.node()}____pid____{os.getpid()}"
        self.place = ""

    @property
    def local(self) -> Address:
        return self._local

    @property
    def remote(self) -> Address:
        return self._remote

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Have a helper meet the peer. Raises RemoteProtocolError, LocalProtocolError."""
        with self._sock:
            if not _slots.acquire(blocking=False):
                raise self._told(f"{MOST} others are being met by MPI: come again")
            try:
                self._start()
                said = self._heard(time.monotonic() + STARTING + MEETING)
                if said != "ok":
                    time.sleep(PENALTY)
            finally:
                _slots.release()
            if said != "ok":
                why = said or "MPI cannot go where you say you are, and its process has ended"
                raise self._told(f"{readable(why)}; {HINT}")

    def _told(self, why: str) -> RemoteProtocolError:
        """The error, of which the peer hears."""
        with suppress(OSError):
            self._sock.sendall(encode_refusal(why))
        return RemoteProtocolError(why)

    def _start(self) -> None:
        inherited = [self._far.fileno(), self._sock.fileno()]
        clean = {key: value for key, value in os.environ.items() if not key.startswith(_STARTED)}
        try:
            process = subprocess.Popen(
                [*_command(), *map(str, inherited)],
                env={**clean, SETTING: "yes"},
                pass_fds=inherited,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
        except OSError as error:
            raise LocalProtocolError(f"no helper for MPI can be started: {error}") from error
        finally:
            self._far.close()
        threading.Thread(target=process.wait, name="yarpy MPI helper", daemon=True).start()
        told = {"kind": self._kind, "pair": self._pair, "place": self.place}
        with suppress(OSError):
            self.sock.sendall(json.dumps(told).encode() + b"\n")

    def _heard(self, until: float) -> str:
        """The line that the helper says, "" if it ends without one."""
        line = b""
        try:
            while not line.endswith(b"\n") and len(line) < _LINE:
                self.sock.settimeout(max(until - time.monotonic(), 0.001))
                if not (byte := self.sock.recv(1)):
                    return ""
                line += byte
        except TimeoutError:
            return "MPI does not come back"
        except OSError:
            return ""
        finally:
            self.sock.settimeout(None)
        return line.decode("utf-8", "replace").strip()

    def set_dscp(self, tos: int) -> None:
        raise LocalProtocolError("packets of MPI have no priority of ours; use tcp for that")

    def tos(self) -> int:
        return 0

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return None

    def close(self) -> None:
        if self._kind == "bcast":  # the others need the helper in the group until it is let go
            with suppress(OSError):
                self.sock.send(LEAVE)
        self._far.close()
        self._sock.close()
        super().close()


def _command() -> list[str]:
    """Return the command line of the helper, with `mpiexec -n 1` where mpiexec started this
    program."""
    command = [sys.executable, "-m", "yarpy.peers.mpi.helper"]
    if not any(key.startswith("PMI_") for key in os.environ):
        return command
    beside = Path(sys.executable).with_name("mpiexec")
    found = str(beside) if beside.exists() else shutil.which("mpiexec")
    return command if found is None else [found, "-n", "1", *command]
