"""shmem: greets over TCP, then both write into memory that the other one sees.

Rules: C++ YARP's own, where it was built with ACE. The acceptor answers with the number at which it
waits; tcp's messages, acknowledgements and answers then go through the memory.
"""

from __future__ import annotations

from yarpy.carriers.base import Indexed
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.wire import framing
from yarpy.wire.effects import Open, Switch
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class Shmem(Indexed):
    """tcp's messages in shared memory."""

    name = "shmem"
    words = ()
    over = "shmem"
    code = 14
    acks = True

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        try:
            answer = yield from framing.read_answer(stream)
        except LinkClosed as error:
            raise RemoteProtocolError(
                f'"{self.route.target}" hangs up: it has no carrier shmem, or is on another '
                "computer; use tcp"
            ) from error
        except AccessRefused:
            raise
        except RemoteProtocolError as error:
            raise RemoteProtocolError(f"{error}; use tcp") from error
        port = framing.parse_number(answer)
        if not 0 < port < 65536:
            raise RemoteProtocolError(f"expected the number of a port, got {answer!r}; use tcp")
        handle = yield Open("shmem", listen=False, port=port)
        yield Switch(handle, ByteStream(stream.limit))

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        handle = yield Open("shmem", listen=True)
        stream.write(framing.number(handle.port))
        yield Switch(handle, ByteStream(stream.limit))
