"""The output of an application's programs in the log of the network, where `yarpy log` shows it.

Rules: one port for all programs, `/log/HOST/APPLICATION/PID`; each line says which program it is
of. Nobody waits: who comes late gets the last lines, and what is lost is counted. A program that
forwards its log by itself (YARP_FORWARD_LOG_ENABLE) is left out, for its lines are there already.
"""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Collection
from functools import partial
from typing import Final

from yarpy.config.configuration import flag
from yarpy.data.bottle import Bottle
from yarpy.kits.launch.application.application import Application
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.keep.log_sender import LOGGER, LogSender
from yarpy.wire.message import Packet

KEPT: Final = 10_000  # lines for loggers that are late
_FORWARDS: Final = "YARP_FORWARD_LOG_ENABLE"
_LEAVING: Final = 5.0  # seconds in which the port opens, if it has not, and the last lines leave


class LogStream:
    """Tells loggers what programs say, from the first line until `close`. `target`: the logger to
    connect to, if it is there."""

    def __init__(
        self, application: Application, names: NameClient | None = None, target: str = LOGGER
    ) -> None:
        self._host = f"/log/{_word(socket.gethostname())}"
        self._skipped = forwarding(application)
        name = f"{self._host}/{_word(application.name)}/{os.getpid()}"
        self._header = f"[{name}]"
        self._headers: dict[str, str] = {}  # of programs
        self._sender = LogSender(partial(open_hub, names=names), name, self._gap, target, KEPT)

    def hear(self, label: str, line: str) -> None:
        """Take a line of the program `label`."""
        if label not in self._skipped:
            header = self._headers.get(label)
            if header is None:
                header = f"[{self._host}/{_word(label)}/{os.getpid()}]"
                self._headers[label] = header
            self._sender.put([Packet([header, f"{line}\n"])])

    def close(self) -> None:
        """Send what is left, for a while."""
        self._sender.close(_LEAVING)

    def _gap(self, lost: int) -> Packet:
        return Packet(Bottle([self._header, f"[WARNING] {lost} lines before this are lost\n"]))


def forwarding(application: Application) -> Collection[str]:
    """Return the labels of programs that forward their log by themselves."""
    return {
        one.label
        for one in application.modules
        if flag({**os.environ, **one.environment}, _FORWARDS, False)
    }


def _word(text: str) -> str:
    """Return a part of the name of a log: it has no slash, and is not empty."""
    return re.sub(r"[\s/\[\]]", "_", text) or "_"
