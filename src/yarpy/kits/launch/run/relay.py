"""Relays: what a program says as messages, and what somebody says to it.

    LogRelay      /log/SERVER/PROGRAM/PID       "[/log/...]" "a line\\n", for loggers
    TerminalRelay UUID/stdout, UUID/stdin       "a line\\n", for the terminal of a yarprun

Rules: the ports are those of C++ yarprun. Whoever comes late gets what was said last. Who writes to
a program that does not read is not waited for.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Final

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import DecodeError
from yarpy.link.begin.admission import Gate
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.keep.log_sender import LogSender
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message, Packet

KEPT: Final = 10_000  # lines for loggers that are late
SHOWN: Final = 1000  # ... and for terminals

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
    """The ports of a terminal. feed: a descriptor to write to, which it closes; gate: who may."""

    def __init__(
        self, uuid: str, feed: int, gate: Callable[[str], Gate], names: NameClient | None
    ) -> None:
        if sys.platform != "win32":  # where `program.open_input` has none
            os.set_blocking(feed, False)
        self._feed = feed
        self._sender = LogSender(
            partial(open_hub, names=names, gate=gate), f"{uuid}/stdout", _gap, "", SHOWN
        )
        self._sender.open()
        try:
            self._input = RpcServer(f"{uuid}/stdin", self._write, names=names, gate=gate, lock=True)
        except BaseException:
            self._sender.close()
            os.close(feed)
            raise

    def hear(self, lines: Sequence[str]) -> None:
        self._sender.put([Packet(Bottle([f"{line}\n"])) for line in lines])

    def close(self) -> None:
        self._input.close()
        self._sender.close(0.0)
        os.close(self._feed)

    def wait(self, seconds: float) -> None:
        self._sender.close(seconds)

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
