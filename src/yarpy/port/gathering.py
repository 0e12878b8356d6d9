"""Gathering: the mailbox of a port that keeps what many connections send.

Rules: as `Callback`, for a function that never waits: one thread calls it for all connections that
send little (`link/receive/gather.py`), and that of its connection for each other message.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarpy.link.receive.gather import ABLE, Gather
from yarpy.link.receive.inbound import Inbound
from yarpy.port.mailbox import Callback
from yarpy.wire.message import Message


class Gathering(Callback):
    """Calls a function with each message."""

    def __init__(self, handler: Callable[[Message[Any]], object]) -> None:
        super().__init__(handler)
        self._gather = Gather() if ABLE else None

    def attend(self, link: Inbound) -> None:
        if self._gather is not None:
            self._gather.attend(link)
