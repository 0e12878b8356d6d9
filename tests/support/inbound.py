"""A link into a port that does what a test says."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from support.transport import ScriptTransport, scripted
from support.wait import HANG

from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import Tcp
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.link.begin.greeting import driver_of
from yarpy.link.receive.inbound import Inbound
from yarpy.route import Route
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire import framing
from yarpy.wire.message import Message, Packet


class Owner:
    """A port that does what a test says."""

    name = "/here"

    def __init__(self) -> None:
        self.heard: list[Message] = []
        self.threads: list[str] = []  # in which it heard them
        self.ended: list[tuple[str, bool]] = []
        self.reversed: list[Inbound] = []
        self.answer: object = None
        self.leave: Inbound | None = None

    def receive(self, link: Inbound, message: Message) -> None:
        self.heard.append(message)
        self.threads.append(threading.current_thread().name)
        if isinstance(self.answer, BaseException):
            raise self.answer
        if self.answer is not None and message.wants_reply:
            message.reply(self.answer)

    def administer(self, link: Inbound, message: Message) -> Bottle:
        if self.leave is not None:
            self.leave.close()
        return Bottle([Vocab("ver"), 1, 2, 3])

    def command(self, link: Inbound, message: Message) -> list[str]:
        if self.leave is not None:
            self.leave.close()
        return [f"you said {message.key}{message.text}"]

    def reverse(self, link: Inbound) -> None:
        self.reversed.append(link)

    def input_ended(self, link: Inbound, reason: str, quit_: bool) -> None:
        self.ended.append((reason, quit_))


def served(
    kind: type[Carrier], *incoming: bytes, answer: object = None
) -> tuple[Owner, ScriptTransport, Inbound]:
    """Serve a connection whose whole input is known."""
    driver, transport = scripted(*incoming)
    owner = Owner()
    owner.answer = answer
    link = Inbound(owner, driver, kind(Route("/peer", "/here", kind.name)))
    link.serve()
    return owner, transport, link


@contextmanager
def linked(
    kind: type[Carrier] = Tcp, attend: Callable[[Inbound], object] = lambda link: None
) -> Iterator[tuple[socket.socket, Inbound, Owner]]:
    """A connection that is served in its thread. attend: called with it before it begins."""
    near, far = socket.socketpair()
    near.settimeout(5)
    owner = Owner()
    link = Inbound(owner, driver_of(SocketTransport(far)), kind(Route("/peer", "/here", kind.name)))
    attend(link)
    link.thread = threading.Thread(target=link.serve, daemon=True)
    link.thread.start()
    try:
        yield near, link, owner
    finally:
        near.close()
        link.thread.join(HANG)
        assert not link.thread.is_alive()


def message(value: object, key: str = "D", envelope: str = "") -> bytes:
    return b"".join(framing.encode(Packet(value, envelope.encode(), key)))  # type: ignore[arg-type]
