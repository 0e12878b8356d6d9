"""mpi and bcast: greet over TCP, then move into a communicator of MPI.

    greeting    MPI_____, MPIBCAST | three lines: the sender's name, its program, where MPI finds it

Rules: C++ YARP's own. No index and no acknowledgements: a port command, then the payload, as on a
unix_stream. Modifiers are not sent. MPI joins no two ports of one program.
"""

from __future__ import annotations

from yarpy.carriers.base import Delivery, introduce
from yarpy.carriers.own.unix_stream import UnixStream
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.facts import MAGIC_SIZE, Reach
from yarpy.limit import MPI_LINE
from yarpy.wire import framing
from yarpy.wire.effects import Open, Switch
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class Mpi(UnixStream):
    """Port commands and payloads as messages of MPI from one program to another."""

    name = "mpi"
    words = ()
    over = "mpi"
    magic = b"MPI_____"
    reaches = Reach(tells=False)

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return MAGIC_SIZE if first == cls.magic else 0

    def greet(self, stream: ByteStream) -> Steps[None]:
        handle = yield Open(self.name, listen=False, group=self._pair)
        lines = (self.route.source, handle.program, handle.place)
        stream.write(self.magic + "".join(f"{line}\r\n" for line in lines).encode())
        yield Switch(handle, ByteStream(stream.limit))

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        source = yield from _line(stream)
        yield from introduce(self, stream, source)
        program = yield from _line(stream)
        place = yield from _line(stream)
        try:
            handle = yield Open(self.name, listen=True, group=self._pair)
        except LocalProtocolError as error:  # it is off here, or missing
            stream.write(framing.encode_refusal(str(error)))
            raise RemoteProtocolError(str(error)) from error
        if program == handle.program:
            handle.close()
            why = f"{self.name} joins no two ports of one program: take local or tcp"
            stream.write(framing.encode_refusal(why))
            raise RemoteProtocolError(why)
        handle.place = place
        yield Switch(handle, ByteStream(stream.limit))

    @property
    def _pair(self) -> str:
        """As C++ has it where one reader of several leaves."""
        return f"{self.route.target}<-{self.route.source}"


class Bcast(Mpi):
    """From one port to all its readers at once, by what MPI has for that."""

    name = "bcast"
    over = "bcast"
    magic = b"MPIBCAST"
    replies = False
    delivery = Delivery(broadcast=True)

    def encode_quit(self, stream: ByteStream) -> None:
        """Not to all: the one that is meant is told by the transport."""


def _line(stream: ByteStream) -> Steps[str]:
    line = yield from stream.read_line(MPI_LINE)
    return bytes(line).decode("utf-8", "replace")
