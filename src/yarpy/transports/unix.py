"""Unix sockets for two ports of one host that met over TCP.

Rules: the path is made of the two TCP port numbers and lies in YARP's runtime directory, which both
processes compute alike. The accepting side binds, waits for one peer, and removes the path. Below
/tmp anybody may have made that directory before us, to stand between the two: it must be ours.
"""

from __future__ import annotations

import array
import os
import socket
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from yarpy import scope
from yarpy.errors import LocalProtocolError, Timeout
from yarpy.platform.user import user
from yarpy.transports.base import Address, Transport
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.tcp import TcpTransport

_LONGEST: Final = 107 if sys.platform == "linux" else 103  # bytes of a path that a socket may have
TIMEOUT = 5.0  # seconds for the two sides to meet
_SIOCOUTQ = 0x5411  # of Linux: what was sent, and not read


def runtime_directory() -> Path:
    """Return the folder of C++ YARP's sockets: $YARP_RUNTIME_DIR, $XDG_RUNTIME_DIR/yarp, or below
    /tmp."""
    own = os.environ.get("YARP_RUNTIME_DIR")
    if own:
        return Path(own)
    shared = os.environ.get("XDG_RUNTIME_DIR")
    if shared:
        return Path(shared) / "yarp"
    number = user()
    name = os.environ.get("USER") or ("" if number is None else str(number))
    return Path(os.environ.get("TMPDIR") or tempfile.gettempdir()) / f"runtime-{name}" / "yarp"


def _made(directory: Path) -> Path:
    """The runtime directory. Raises LocalProtocolError if others could change what is in it."""
    directory.mkdir(parents=True, exist_ok=True, mode=0o700)
    if os.environ.get("YARP_RUNTIME_DIR") or os.environ.get("XDG_RUNTIME_DIR"):
        return directory  # where its owner wants it
    for path in (directory.parent, directory):
        found = path.lstat()
        if user() not in (None, found.st_uid):
            raise LocalProtocolError(
                f"another user of this computer made {path}, and could read what goes through "
                "sockets in it: set XDG_RUNTIME_DIR, or take the carrier tcp"
            )
        if found.st_mode & 0o022:  # by the umask of who made it
            path.chmod(found.st_mode & 0o755)
    return directory


def open_unix(listen: bool, local: Address, remote: Address) -> UnixTransport:
    """The Unix side of a connection that greeted over TCP from `local` to `remote`."""
    if not hasattr(socket, "AF_UNIX"):
        raise LocalProtocolError("this system has no Unix sockets; use the carrier tcp")
    if local[0] != remote[0]:
        raise LocalProtocolError(
            f"unix_stream joins ports of one host, not {local[0]} and {remote[0]}; use tcp"
        )
    first, second = (local, remote) if listen else (remote, local)
    path = str(_made(runtime_directory()) / f"{first[1]}_{second[1]}.sock")
    if len(os.fsencode(path)) > _LONGEST:
        raise LocalProtocolError(
            f"{path} is too long for a Unix socket: set XDG_RUNTIME_DIR to a directory with a "
            "shorter path, or take the carrier tcp"
        )
    return UnixTransport(path, listen)


class UnixTransport(TcpTransport):
    """A Unix stream socket; connected once `ready` has returned."""

    _reset = False  # the peer hung up without having read all

    def __init__(self, path: str, listen: bool) -> None:
        self._path = path
        self._listen = listen
        if sys.platform == "win32":
            raise NotImplementedError
        super().__init__(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM))
        if listen:
            Path(path).unlink(missing_ok=True)
            self.sock.bind(path)
            self.sock.listen(1)

    @property
    def local(self) -> Address:
        return self._path, 0

    @property
    def remote(self) -> Address:
        return self._path, 0

    def ready(self, look: Callable[[], object] | None = None) -> None:
        if self._listen:
            listener = self.sock
            try:
                listener.settimeout(TIMEOUT)
                self.use(listener.accept()[0])
            finally:
                listener.close()
                Path(self._path).unlink(missing_ok=True)
            self.sock.setblocking(True)
        else:
            deadline = time.monotonic() + scope.left(TIMEOUT)
            while True:
                try:
                    self.sock.connect(self._path)
                    break
                except (FileNotFoundError, ConnectionRefusedError):
                    if time.monotonic() >= deadline:
                        raise Timeout("the peer is silent") from None
                    if look is not None:
                        look()
                    scope.sleep(0.01)  # the other side is about to listen

    def set_dscp(self, tos: int) -> None:
        raise LocalProtocolError("a Unix socket has no packet priority; use tcp for that")

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """Return how much the peer has read, and whether that was all before it hung up. What it
        has not read takes room in our send buffer; more than fits there, it has read. If it closes
        before it has read all, the system says so once, and throws the rest away after that. Other
        systems than Linux do not tell."""
        if sys.platform != "linux":
            return None
        import fcntl

        unread = array.array("i", [0])
        try:
            fcntl.ioctl(self.sock.fileno(), _SIOCOUTQ, unread)
            if self.sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
                self._reset = True
            if not unread[0] and not self._reset:
                return sent, self.ended() and not self._reset
            return sent - self.sock.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF), False
        except (OSError, ValueError):  # or another thread has closed the socket
            return None

    def failed(self, error: OSError) -> None:
        self._reset = self._reset or isinstance(error, ConnectionResetError)

    def close(self) -> None:
        super().close()
        if self._listen:
            Path(self._path).unlink(missing_ok=True)


class Unix(Opener):
    """Unix sockets between programs of one computer."""

    name = "unix"
    meets = False
    stays = True
    system = "posix"
    uses = "Unix sockets in Python"

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        through = place.through
        return open_unix(place.listen, through.local, through.remote)
