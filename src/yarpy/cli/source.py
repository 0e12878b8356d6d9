"""A port that a command wants to hear from: connected as soon as it is there, also when it returns.

Rules: what can never work (an invalid name, an unknown carrier) is an error at once; what is not
there yet is waited for. A disconnection on request is respected: only a source that was gone
meanwhile is connected again. Cameras, which have an address and no name, are dialled again
by the port itself.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import yarpy
from yarpy.cli.ports import hear_from
from yarpy.cli.stderr import warn

if TYPE_CHECKING:
    from yarpy.port.base import BasePort

PAUSE: Final = 0.5  # seconds between looks


def also_said(tell: Callable[[str], object]) -> Callable[[str], object]:
    """Return a `tell` that also says on standard error what is waited for."""

    def both(line: str) -> None:
        if line:
            warn(line)
        tell(line)

    return both


class Source:
    """`port` is to hear `name` (`/cam`, `udp://cam`, `mjpeg+path.video://10.0.0.5:8080/`).

    tell: called with a line for people while it waits, and with "" when it is connected.
    Raises AddressError, UnknownPlugin, NoNameServer, LoginRefused.
    """

    def __init__(
        self,
        port: BasePort,
        name: str,
        carrier: str | None = None,
        tell: Callable[[str], object] = lambda line: None,
    ) -> None:
        from yarpy.contact import parse_contact
        from yarpy.link.begin.handshake import asked_carrier
        from yarpy.route import masked, parse_carrier

        self._port = port
        self._name = name
        self._shown = masked(name)
        self._carrier = carrier
        self._tell = tell
        self._contact = parse_contact(name)
        if self._contact.carrier != "topic":
            asked_carrier(parse_carrier(carrier or self._contact.carrier or "tcp"))
        self._wanted = True
        self._told = ""
        self._look()
        threading.Thread(
            target=self._follow, name=f"yarpy source {self._shown}", daemon=True
        ).start()

    @property
    def connected(self) -> bool:
        """Return whether it sends to the port now."""
        name = self._contact.label.rstrip("/")
        return any(link.source.rstrip("/") == name for link in self._port.inputs)

    def _follow(self) -> None:
        while True:
            threading.Event().wait(PAUSE)
            if self._port.closed:
                return
            try:
                self._look()
            except yarpy.YarpError as error:
                if not self._port.closed:  # which is why it failed, and how commands end
                    self._tell(str(error))

    def _look(self) -> None:
        """Connect it if it is wanted and there."""
        if self.connected:
            self._wanted = False
        elif self._wanted:
            self._connect()
        elif not self._contact.placed and self._contact.carrier != "topic":
            self._wanted = not yarpy.exists(self._contact.name)

    def _connect(self) -> None:
        try:
            hear_from(self._port, self._name, self._carrier or "")
        except (yarpy.UnknownPlugin, yarpy.AddressError, yarpy.NoNameServer):
            raise
        except yarpy.LoginRefused:
            self._wanted = False  # a camera locks those out who try again and again
            raise
        except yarpy.YarpError as error:
            if self._port.closed:
                return
            line = f"Waiting for {self._shown}: {error}"
            if line != self._told:  # once, not at every look
                self._told = line
                self._tell(line)
        else:
            self._wanted, self._told = False, ""
            self._tell("")
