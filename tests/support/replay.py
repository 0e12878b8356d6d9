"""Captures said again to our carriers, without a transport, in either role.

Rules: pure. `serve` is what a port does with a connection (link/inbound.py), reduced to its bytes;
`dial` is what a sender does. What a port's owner would answer is given from outside.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from support.capture import Capture

from yarpy.carriers.base import Carrier
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.link.begin.handshake import UNKNOWN_PROTOCOL, find_carrier, recognise
from yarpy.route import Route
from yarpy.testing import End
from yarpy.wire.message import Lines, Message, Packet
from yarpy.wire.steps import Steps

Answer = Callable[[Message], Any]


def echo(message: Message) -> Any:
    """The server of most captures, with our way of refusing what cannot be read."""
    try:
        return [Vocab("ok"), "echo", message.as_(Bottle)]
    except DecodeError as error:
        return [Vocab("fail"), str(error)]


def silent(message: Message) -> Any:
    """A port that only reads."""
    return None


def scripted(answers: Iterable[Any]) -> Answer:
    """These answers, in order; the last counts for whatever follows."""
    rest = list(answers)
    return lambda message: rest.pop(0)


@dataclass
class Served:
    """What an acceptor has learnt: its carrier, and every message in order."""

    carrier: Carrier | None = None
    messages: list[Message] = field(default_factory=list)
    reversed: bool = False


def serve(end: End, served: Served, answer: Answer, port: int = 0, host: str = "") -> Steps[None]:
    """Welcome whoever it is and answer until they quit. `host`: where they reached us."""
    first = bytes((yield from end.stream.read_exact(8)))
    kind = recognise(first)
    if kind is None:
        end.stream.write(UNKNOWN_PROTOCOL)
        return
    carrier = served.carrier = kind(Route("", "/cap/target", kind.name, port, host))
    yield from carrier.welcome(end.stream, first)
    while True:
        message = yield from carrier.decode(end.stream)
        served.messages.append(message)
        stream = end.stream
        if message.key in ("d", "a"):
            value = answer(message)
            if value is not None:
                carrier.encode_reply(stream, value)
            elif carrier.spelling == "binary" and carrier.acks:
                carrier.encode_reply(stream, Bottle())
        elif message.key == "D":
            pass
        elif message.key not in ("q", "r"):
            carrier.encode_lines(stream, answer(message))
        if carrier.acks:
            carrier.encode_ack(stream, 1)
        if message.key in ("q", "r"):
            served.reversed = message.key == "r"
            return


def dial(
    end: End, carrier: Carrier, messages: Sequence[Message], replies: list[Any]
) -> Steps[None]:
    """Greet, and send `messages`; each waits for its reply and acknowledgement."""
    yield from carrier.greet(end.stream)
    for message in messages:
        yield from send(end, carrier, message, replies)


def send(
    end: End, carrier: Carrier, message: Message, replies: list[Message | None] | None = None
) -> Steps[None]:
    """Send one message of a capture again, and read what comes back."""
    stream = end.stream
    if message.key == "q":
        carrier.encode_quit(stream)
    else:
        value = message.as_(Bottle)
        carrier.encode(stream, Packet(value, message.envelope.encode(), message.key))
    if message.key in ("d", "a") and replies is not None:
        replies.append((yield from carrier.expect_reply(stream)))
    if carrier.acks:
        yield from carrier.expect_ack(stream)


def read(end: End, carrier: Carrier, count: int, found: list[Message]) -> Steps[None]:
    """Read and acknowledge `count` messages: a reader that dialled and reversed."""
    while len(found) < count:
        found.append((yield from carrier.decode(end.stream)))
        if carrier.acks:
            carrier.encode_ack(end.stream, 1)


def messages_of(capture: Capture) -> tuple[Carrier, list[Message]]:
    """Who dialled in a capture, and everything that was sent, as our own acceptor reads it."""
    end, served = End(), Served()
    end.begin(serve(end, served, lambda message: [] if message.key in "da" else ["?"]))
    for step in capture.steps:
        if step.sender == "a" and not end.done:
            end.feed(step.data)
    assert served.carrier is not None
    return served.carrier, served.messages


def initiator_of(capture: Capture) -> Carrier:
    """A carrier that dials as the one in the capture did."""
    accepting, _ = messages_of(capture)
    route = accepting.route
    return find_carrier(route.spec)(Route(route.source, route.target, route.spec))


def answers_of(capture: Capture) -> list[Any]:
    """What the port of a text capture answered, one item for each message that has an answer."""
    accepting, messages = messages_of(capture)
    ack = "<ACK>\r\n" if accepting.acks else ""
    steps = iter(capture.steps[2:])
    found: list[Any] = []
    for step in steps:
        if step.sender == "b":
            text = step.data.decode("utf-8", "surrogateescape").removesuffix(ack)
            found.append(text)
    asking = [m for m in messages if m.key not in ("D", "q", "r")]
    return [_answer(message, text) for message, text in zip(asking, found, strict=False)]


def _answer(message: Message, text: str) -> Any:
    lines = text.split("\r\n")[:-1]
    if message.key not in ("d", "a"):
        return lines
    if lines and lines[-1].startswith("*** end"):
        return Lines(lines)
    return Bottle.from_text(lines[0] if lines else "")
