"""Relays: what a program says as messages, and what somebody says to it.

    LogRelay      /log/SERVER/PROGRAM/PID       "[/log/...]" "a line\\n", for loggers
    TerminalRelay UUID/stdout, UUID/stdin       "a line\\n", for the terminal of a yarprun

Rules: the ports are those of C++ yarprun. Whoever comes late gets what was said last. Who writes to
a program that does not read is not waited for.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import DecodeError
from yarpy.link.begin.admission import Gate
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.connection import ConnectionEvent
from yarpy.port.hub import Hub
from yarpy.port.keep.log_sender import LogSender
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message, Packet

KEPT: Final = 10_000  # lines for loggers that are late
SHOWN: Final = 1000  # ... and for terminals
OPENING: Final = 5.0  # seconds for the port that a terminal is told of
ATTACHING: Final = 5.0  # seconds for a terminal to come to a program that ended at once

log = logger("yarpy.run")


class LogRelay:
    """Tells loggers what a program says. name: of the port. target: a logger to connect to, if it
    is there."""

    def __init__(self, name: str, target: str, names: NameClient | None) -> None:
        self._header = f"[{name}]"
        self._sender = LogSender(partial(open_hub, names=names), name, self._gap, target, KEPT)
        self._sender.open()

    def hear(self, lines: Sequence[str]) -> None:
        self._sender.put([self._packet(f"{line}\n") for line in lines])

    def close(self) -> None:
        self._sender.close(0.0)

    def wait(self, seconds: float) -> None:
        self._sender.close(seconds)

    def _packet(self, text: str) -> Packet:
        return Packet(Bottle([self._header, text]))

    def _gap(self, lost: int) -> Packet:
        return self._packet(f"[WARNING] {lost} lines before this one are lost\n")


class TerminalRelay:
    """The ports of a terminal: there when it is made, and a while longer than the program if none
    has come yet. feed: a descriptor to write to, which it closes; gate: who may."""

    def __init__(
        self, uuid: str, feed: int, gate: Callable[[str], Gate], names: NameClient | None
    ) -> None:
        if sys.platform != "win32":  # where `program.open_input` has none
            os.set_blocking(feed, False)
        self._feed = feed
        self._names, self._gate = names, gate
        self._opened, self._met = threading.Event(), threading.Event()
        self._sender = LogSender(self._open, f"{uuid}/stdout", _gap, "", SHOWN)
        self._sender.open()
        self._end = threading.Thread(target=self._leave, name=f"end of {uuid}", daemon=True)
        self._ending = False
        try:
            self._input = RpcServer(f"{uuid}/stdin", self._write, names=names, gate=gate, lock=True)
        except BaseException:
            self._sender.close()
            os.close(feed)
            raise
        self._opened.wait(OPENING)

    def hear(self, lines: Sequence[str]) -> None:
        self._sender.put([Packet(Bottle([f"{line}\n"])) for line in lines])

    def close(self) -> None:
        if not self._ending:
            self._ending = True
            self._end.start()

    def wait(self, seconds: float) -> None:
        until = time.monotonic() + seconds
        self._met.set()
        self._end.join(max(seconds, 0.0))
        self._sender.close(until - time.monotonic())

    def _open(self, name: str, mailbox: Any, on_connection: Callable[[Any], object]) -> Hub:
        """Open the port of what is said."""

        def see(event: ConnectionEvent) -> None:
            if event.created and not event.incoming:
                self._met.set()
            on_connection(event)

        try:
            return open_hub(name, mailbox, on_connection=see, names=self._names, gate=self._gate)
        finally:
            self._opened.set()

    def _leave(self) -> None:
        self._met.wait(ATTACHING)
        self._input.close()
        self._sender.close(0.0)
        os.close(self._feed)

    def _write(self, message: Message) -> None:
        try:
            value = message.as_(Bottle)
        except DecodeError:
            return
        text = plain_text(value[0]) if len(value) == 1 else f"{value.to_text()}\n"
        with suppress(BlockingIOError):
            os.write(self._feed, text.encode("utf-8", "surrogateescape"))


def _gap(lost: int) -> Packet:
    return Packet(Bottle([f"[yarpy run] {lost} lines before this one are lost\n"]))
