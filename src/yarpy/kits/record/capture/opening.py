"""The start of a recorder: the name of its file, and its port.

Rules: nothing that lives is replaced. Several recorders run side by side.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from yarpy.errors import AddressError
from yarpy.kits.record.sink import ENDING, named
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.connection import ConnectionEvent
from yarpy.port.gathering import Gathering
from yarpy.port.port import MessagePort


def without_ending(path: str | Path | None) -> Path:
    """Return the path of a recording; None is the date. Raises LocalProtocolError."""
    if path is None:
        return Path(time.strftime("record-%Y-%m-%d-%H-%M-%S"))
    found = named(path)
    return found.with_suffix("") if found.suffix == ENDING else found


def open_port(
    name: str,
    take: Callable[[Any], None],
    connection: Callable[[ConnectionEvent], None],
    names: NameClient | None,
    usual: str = "/record",
) -> MessagePort:
    """Return the port, by that name, or by one that is free. Raises AddressError, NoNameServer."""
    tries: Sequence[str] = [name] if name else [usual, f"{usual}/{os.getpid()}", "..."]
    for number, one in enumerate(tries):
        try:
            mailbox = Gathering(take)
            return MessagePort(open_hub(one, mailbox, names, on_connection=connection))
        except AddressError:
            if number == len(tries) - 1:
                raise
    raise AssertionError
