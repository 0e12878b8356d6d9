"""Hosted: what carriers have in common that send and receive by another middleware.

Rules: there is no connection of their own: `greet` is handed the endpoint, and then what goes and
comes are objects, which whoever made the endpoint sends and receives. A carrier is a port that
sends, or one of three other classes: a reader, who asks, who answers.
"""

from __future__ import annotations

from typing import Any, ClassVar, Final

from yarpy.carriers.base import Carrier, Delivery, refuse_unknown
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.facts import TOPIC
from yarpy.route import CarrierSpec
from yarpy.wire.message import CALL, Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, ObjectStream

#: additions of a carrier's name
SERVICE: Final = "srv"
LISTENS: Final = "sub"


class Hosted(Carrier):
    """The end of a port at a middleware."""

    reaches = TOPIC
    replies = False
    words: ClassVar[tuple[str, ...]] = ()
    delivery = Delivery(coalesces=False)

    @classmethod
    def roles(cls) -> tuple[type[Carrier], type[Carrier], type[Carrier]]:
        """Return the carriers that read, that ask, and that answer."""
        raise NotImplementedError

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        refuse_unknown(spec, cls.words)
        reader, asker, server = cls.roles()
        serves = SERVICE in spec.tokens
        if LISTENS in spec.tokens:
            return server if serves else reader
        return asker if serves else cls

    def write_object(self, stream: ByteStream, item: object) -> None:
        """Have the endpoint send that."""
        assert isinstance(stream, ObjectStream)
        stream.write_object(item)

    def read_object(self, stream: ByteStream) -> Steps[Any]:
        """Return the next object that the endpoint has received; the first is the endpoint
        itself."""
        assert isinstance(stream, ObjectStream)
        return (yield from stream.read_object())

    def come(self, stream: ByteStream) -> Any:
        """Return the next object if it is there, else None."""
        assert isinstance(stream, ObjectStream)
        return stream.items.pop(0) if stream.items else None

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends it."""


def failure(reason: str) -> Message:
    """The reply of a question that has none: `[fail] "reason"`."""
    return Message(CALL, b"".join(codec.encode([Vocab("fail"), reason])))
