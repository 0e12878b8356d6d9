"""abstract: the sockets of Linux that have a name and no file, between programs of one computer.

An Opener says how the two ends of a connection meet; what is opened is a Transport, of which
SocketTransport has nearly everything.
"""

import socket
import time
from collections.abc import Callable

from yarpy.errors import LocalProtocolError
from yarpy.transports.base import Transport
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.socket_transport import SocketTransport


class AbstractSockets(Opener):
    """Both ends are told by the TCP connection that they have greeted over, so they find a name."""

    name = "abstract"
    stays = True  # nothing leaves the computer

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        ends = sorted((place.through.local, place.through.remote))
        if ends[0][0] != ends[1][0]:
            raise LocalProtocolError("abstract sockets are for programs of one computer: take tcp")
        name = f"\0yarpy-json-{ends[0][1]}-{ends[1][1]}"
        return AbstractSocket(name, place.listen, place.timeout)


class AbstractSocket(SocketTransport):
    """One end; `ready` waits for the other."""

    scheme = "abstract"

    def __init__(self, name: str, listen: bool, timeout: float) -> None:
        super().__init__(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM))
        self._name, self._listen, self._timeout = name, listen, timeout
        if listen:
            self.sock.bind(name)
            self.sock.listen(1)

    def ready(self, look: Callable[[], object] | None = None) -> None:
        if self._listen:
            with self.sock as listener:
                listener.settimeout(self._timeout)
                self.use(listener.accept()[0])
            self.sock.setblocking(True)
            return
        end = time.monotonic() + self._timeout
        while True:
            try:
                return self.sock.connect(self._name)
            except ConnectionRefusedError:  # the other side is about to listen
                if look is not None:
                    look()  # raises where it will not
                if time.monotonic() > end:
                    raise
                time.sleep(0.005)
