"""The port of an application's page, opened when somebody wants to see it.

Rules: reachable from this computer alone, whatever other ports of the program are; by its owner
alone (`gate`). Without a name server it is a port without a name.
"""

from __future__ import annotations

import os
import threading
from typing import Final

import yarpy
from yarpy.kits.launch.console.service import answer
from yarpy.kits.launch.page.gate import OwnerGate
from yarpy.kits.launch.page.owner import Owners
from yarpy.kits.launch.page.page import ApplicationPage
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.names.base import NameClient
from yarpy.transports.bind import SETTING
from yarpy.transports.tls_setting import required

_BESIDE: Final = 9  # names that are tried


class Serving:
    """The page of an application, from its first `url` on until `close`."""

    def __init__(self, supervisor: Supervisor, names: NameClient | None = None) -> None:
        self._supervisor = supervisor
        self._names = names
        self._lock = threading.Lock()  # several may ask for it at once
        self._port: yarpy.Port | None = None

    def url(self) -> str:
        """Return where the page is; it is opened now if it is not yet."""
        with self._lock:
            if self._port is None:
                self._port = self._open()
                supervisor = self._supervisor
                ApplicationPage(
                    self._port,
                    lambda asked: answer(supervisor, asked),
                    Owners(supervisor.sessions, names=self._names),
                    lambda: supervisor.application.modules,
                )
            return f"http{'s' if required() else ''}://{self._port.address}/"

    def close(self) -> None:
        """Show it no more."""
        with self._lock:
            if self._port is not None:
                self._port.close()

    def _open(self) -> yarpy.Port:
        base = f"/up/{self._supervisor.application.name}"
        before = os.environ.get(SETTING)
        os.environ[SETTING] = "local"  # ports read it when they open; programs are not to have it
        try:
            for number in range(1, _BESIDE + 1):
                name = base if number == 1 else f"{base}/{number}"
                try:
                    return self._port_of(name, self._names)
                except yarpy.AddressError:
                    continue  # taken, or no name of a port
                except yarpy.NoNameServer:
                    break
            return self._port_of("/up", yarpy.LocalNames())
        finally:
            if before is None:
                del os.environ[SETTING]
            else:
                os.environ[SETTING] = before

    @staticmethod
    def _port_of(name: str, names: NameClient | None) -> yarpy.Port:
        return yarpy.Port(name, callback=lambda message: None, gate=OwnerGate, names=names)
