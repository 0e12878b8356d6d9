"""Payload: a question or an answer as bytes; and the words that every service knows.

Rules: as text, a payload is the value of its bytes.
"""

from __future__ import annotations

from typing import Final

from yarpy.data.value import Buffer
from yarpy.idl.thrift.extent import Ending

#: asks for the version of an interface, and of YARP (3.12 and later)
VERSION: Final = "getRemoteProtocolVersion"
#: asks why the last call failed (yarpy)
FAILURE: Final = "help_failure"


class Payload:
    """Bytes to send. `ending`, of a question: what finds the end of a reply that is no Bottle."""

    __slots__ = ("data", "ending")

    def __init__(self, data: Buffer, ending: Ending | None = None) -> None:
        self.data = data
        self.ending = ending

    def to_wire(self) -> tuple[Buffer, ...]:
        """The bytes."""
        return (self.data,)
