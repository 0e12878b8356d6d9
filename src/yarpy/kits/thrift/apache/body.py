"""A call of Apache Thrift in the body of a POST, as THttpClient sends it.

Rules: a body is one message, without a frame; its first bytes say in which protocol.
"""

from __future__ import annotations

from typing import Final

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.message import (
    NO_SERVICE,
    NOTHING,
    Answer,
    arrived,
    faulty,
    refusal_of,
    spelling_of,
    whole,
)
from yarpy.kits.thrift.apache.protocol import CALL, ONEWAY, UNKNOWN_METHOD

KIND: Final = "application/x-thrift"


class Body:
    """The body of a request, and of its response. DecodeError for what is no call."""

    kind = KIND

    def __init__(self, data: Buffer) -> None:
        self._spelled = spelling_of(bytes(data[:8]))
        if not self._spelled:
            raise DecodeError(
                f"a body of {KIND} begins as TBinaryProtocol or TCompactProtocol does"
            )
        self.message = arrived(self._spelled, data)
        if self.message.head.kind not in (CALL, ONEWAY):
            raise DecodeError(
                f"a message of kind {self.message.head.kind}, where calls are expected"
            )

    def reply(self, value: object) -> bytes:
        """Return the answer to the call; b"" where it wants none."""
        head = self.message.head
        if value is NOTHING or (value is None and head.kind == ONEWAY):
            return b""
        if not isinstance(value, Answer):
            value = faulty(self._spelled, UNKNOWN_METHOD, NO_SERVICE + refusal_of(value))
        return whole(self._spelled, head, value)
