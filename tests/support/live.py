"""Captures said again to real ports over real sockets.

Rules: whatever the port of a capture was connected to is set up with `LocalNames`. Every byte must
be that of C++ 3.9.1 unless support/difference.py says otherwise. At the end the client closes its
side: nothing more may come.
"""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator

from support.capture import Capture, Step
from support.difference import LIVE_DIFFERENT
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.nameserver.local import LocalNames
from yarpy.port.base import BasePort
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.wire.message import Message


def echo(message: Message) -> object:
    return [Vocab("ok"), "echo", message.as_(Bottle)]


class World:
    """The ports of the recording, without a name server."""

    def __init__(self) -> None:
        self.names = LocalNames()
        self.heard: list[Message] = []
        self._stack = contextlib.ExitStack()
        self.ports: dict[str, BasePort] = {}

    def __enter__(self) -> World:
        return self

    def __exit__(self, *details: object) -> None:
        self._stack.close()

    def port(self, name: str) -> BasePort:
        """The port of that name, opened when it is first needed."""
        if name not in self.ports:
            port: BasePort
            if name.startswith("/cap/srv"):
                port = RpcServer(name, echo, names=self.names)
            elif name.startswith("/cap/rc"):
                port = RpcClient(name=name, names=self.names)
            else:
                port = Port(name, names=self.names, callback=self.heard.append)
            self.ports[name] = self._stack.enter_context(port)
        return self.ports[name]

    def connect(self, source: str, target: str) -> None:
        """Connect them; whoever asked the target who it is has left, too, and is not listed."""
        inputs = self.port(target)._hub.inputs
        before = len(inputs.links)
        self.port(source).connect(target)
        wait_until(lambda: [link.route.source for link in inputs.links[before:]] == [source])

    def admin(self, name: str, text: str) -> None:
        network.admin(name, *Bottle.from_text(text), names=self.names)

    @contextlib.contextmanager
    def dial(self, name: str) -> Iterator[socket.socket]:
        """A bare socket to a port."""
        contact = self.port(name).contact
        with socket.create_connection((contact.host, contact.port), HANG) as sock:
            sock.settimeout(HANG)
            sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            yield sock


def say(sock: socket.socket, data: bytes, piece: int) -> None:
    """Send; the peer may have hung up meanwhile, as C++ had."""
    with contextlib.suppress(ConnectionError):
        if not piece:
            sock.sendall(data)
        else:
            for start in range(0, len(data), piece):
                sock.sendall(data[start : start + piece])


def hear(sock: socket.socket, count: int) -> bytes:
    """Exactly so many bytes, or fewer if the connection ends."""
    data = b""
    while len(data) < count:
        try:
            part = sock.recv(count - len(data))
        except ConnectionResetError:  # it hung up before it had read what we said
            part = b""
        except TimeoutError:
            raise AssertionError(f"of {count} bytes only {data!r} came") from None
        if not part:
            break
        data += part
    return data


def until_right(sock: socket.socket, check: object) -> None:
    """Read until an answer of unknown length satisfies its check."""
    assert callable(check)
    data = b""
    deadline = time.monotonic() + HANG
    while True:
        try:
            check(data)
            return
        except AssertionError:
            if time.monotonic() > deadline:
                raise
        try:
            part = sock.recv(65536)
        except TimeoutError:
            part = b""
        if not part:
            check(data)
            raise AssertionError(f"only {data!r} came")
        data += part


def answer(capture: Capture, step: Step) -> tuple[Step | None, bytes]:
    following = capture.steps[step.index + 1 : step.index + 2]
    if following and following[0].sender == "b":
        return following[0], following[0].data
    return None, b""


def replay(sock: socket.socket, capture: Capture, piece: int) -> None:
    differences = LIVE_DIFFERENT.get(capture.name, {})
    for step in capture.steps:
        if step.sender != "a":
            continue
        say(sock, step.data, piece)
        difference = differences.get(step.index)
        following, wanted = answer(capture, step)
        if difference is not None:
            if callable(difference.ours):
                until_right(sock, difference.ours)
            else:
                assert hear(sock, len(difference.ours)) == difference.ours
        elif following is not None:
            got = hear(sock, len(wanted))
            assert capture.masked(following, got) == capture.masked(following, wanted)


def nothing_more(sock: socket.socket) -> None:
    """Close our side; the port hangs up without another byte."""
    with contextlib.suppress(OSError):
        sock.shutdown(socket.SHUT_WR)
    try:
        assert sock.recv(1000) == b""
    except ConnectionError:
        pass  # it had hung up, and did not read our last words
