"""NameServer: a name server in a program, as that has it in hand.

Rules: what serves (`serving.py`) is kept by its threads, this by the program alone; so one that is
dropped is closed, with a warning, like every port.
"""

from __future__ import annotations

import sys
import threading
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Self

from yarpy.config.configuration import ROOT
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT
from yarpy.nameserver.command import NameService
from yarpy.nameserver.delegate import Delegate
from yarpy.nameserver.serving import Serving
from yarpy.port.hub import Hub


class NameServer:
    """A YARP name server in this process. Port 0 takes any free number.

    Used as a context manager it is this process's default server while open; `environment` is what
    a child process needs to use it too. C++ YARP programs can use it like their own.

    host: the address to tell others; the server listens on all. portdb, subdb: SQLite files for
    registrations and for subscriptions; without, nothing survives the server. cautious: who changes
    something gets the answer when it is on the disk. discoverable: answer
    multicast searches (`yarpy detect`). web: a directory whose files browsers see at `/web/`.
    beside: other systems that are told of names and asked for them, each with its place, "" for the
    usual one: `{"ros": "http://localhost:11311/", "zenoh": ""}`.
    Raises AddressError if the port number is taken, or there is no such directory; NoNameServer if
    nobody answers at a place; UnknownPlugin.
    """

    def __init__(
        self,
        port: int = 0,
        host: str = "127.0.0.1",
        *,
        name: str = ROOT,
        portdb: str | Path | None = None,
        subdb: str | Path | None = None,
        cautious: bool = False,
        discoverable: bool = False,
        web: str | Path | None = None,
        beside: Mapping[str, str] | None = None,
    ) -> None:
        self._serving = Serving(
            port,
            host,
            name=name,
            portdb=portdb,
            subdb=subdb,
            cautious=cautious,
            discoverable=discoverable,
            web=web,
            beside=beside,
        )
        self._closed = False

    @property
    def name(self) -> str:
        """The name of its port, `/root` if nothing else was said."""
        return self._serving.name

    @property
    def host(self) -> str:
        """The address that it tells others."""
        return self._serving.host

    @property
    def port(self) -> int:
        """The TCP port number that it listens on."""
        return self._serving.port

    @property
    def address(self) -> str:
        """`host:port`."""
        return self._serving.hub.contact.address

    @property
    def environment(self) -> dict[str, str]:
        """Variables for a child process that is to use this server: `{**os.environ, **these}`."""
        return {"YARPY_SERVER": self.address}

    @property
    def client(self) -> YarpNameClient:
        """A client of it: the `names` of ports that are to use it."""
        return self._serving.client

    @property
    def service(self) -> NameService:
        """Return what it knows, with the commands that it understands."""
        return self._serving.service

    @property
    def hub(self) -> Hub:
        """The server's port: its connections and counters."""
        return self._serving.hub

    @property
    def delegates(self) -> list[Delegate]:
        """The other systems that are told of names and asked for them."""
        return self._serving.delegates

    @property
    def on_command(self) -> Callable[[str, str], None] | None:
        """Called with each command and the host that it came from, if set."""
        return self._serving.on_command

    @on_command.setter
    def on_command(self, callback: Callable[[str, str], None] | None) -> None:
        self._serving.on_command = callback

    def close(self) -> None:
        """Stop serving. Registered ports go on, and register again with the next server."""
        self._closed = True
        self._serving.close()

    def serve(self) -> None:
        """Wait until the process is interrupted."""
        threading.Event().wait()

    def __enter__(self) -> Self:
        DEFAULT.push(self.client)
        return self

    def __exit__(self, *details: object) -> None:
        DEFAULT.pop(self.client)
        self.close()

    def __del__(self) -> None:
        """Nobody can close it any more. Closing waits for threads, so a thread of its own does
        it."""
        serving = getattr(self, "_serving", None)
        if serving is None or self._closed or sys.is_finalizing():
            return
        warnings.warn(
            f"the name server at {self.address} was dropped without being closed: call close(), or "
            "use it in a `with` statement",
            ResourceWarning,
            stacklevel=2,
            source=self,
        )
        DEFAULT.pop(self.client)
        threading.Thread(target=serving.close, name=f"yarpy close {self.name}", daemon=True).start()

    def __repr__(self) -> str:
        return f"<NameServer {self.name} at {self.address}>"
