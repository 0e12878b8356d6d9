"""A port that listens to a topic which may come later, go away and come back.

Rules: while the topic is not connected it is looked for, at first often, later once a second. What
can never work (an invalid name, an unknown carrier) is an error at once.
"""

from __future__ import annotations

import threading
from typing import Final

from yarpy.errors import AddressError, UnknownPlugin, YarpError
from yarpy.log import logger
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import MessagePort
from yarpy.qos import Qos

log = logger("yarpy.wrap")

FIRST: Final = 0.05  # seconds between two looks
LAST: Final = 1.0


class Follower:
    """Keeps `port` connected to `topic` over `carrier`, until `close`."""

    def __init__(
        self, port: MessagePort, topic: str, carrier: str = "", qos: Qos | None = None
    ) -> None:
        self._port = port
        self._topic = topic
        self._carrier = carrier
        self._qos = qos
        self._event = threading.Event()
        self._connected = threading.Condition()
        self._met = self._closed = False
        self.why = ""  # it is not connected: what the last look met
        port.on_connection(self._on_connection)
        if not self._look():
            self._event.set()
        self._thread = threading.Thread(
            target=self._follow, name=f"yarpy wrap {topic}", daemon=True
        )
        self._thread.start()

    @property
    def connected(self) -> bool:
        """True while the topic sends here."""
        return bool(self._port.inputs)

    def wait(self, timeout: float | None) -> bool:
        """Wait until the topic has been connected; False if time is over or this is closed.

        It may have gone again meanwhile: what it sent is in the port.
        """
        with self._connected:
            self._connected.wait_for(lambda: self._met or self._closed, timeout)
            return self._met and not self._closed

    def close(self) -> None:
        """Look no more. The port is the caller's to close."""
        self._closed = True
        self._event.set()
        with self._connected:
            self._connected.notify_all()

    def _on_connection(self, event: ConnectionEvent) -> None:
        if event.incoming and not event.created:
            self._event.set()
        elif event.incoming:
            self._grant()
            self._meet()

    def _meet(self) -> None:
        with self._connected:
            self._met = True
            self._connected.notify_all()

    def _grant(self) -> None:
        """Give the connection its priority."""
        if self._qos is None:
            return
        for connection in self._port.inputs:
            try:
                connection.qos = self._qos
            except YarpError as error:
                log.warning("%s has no priority here: %s", self._topic, error)

    def _follow(self) -> None:
        pause = FIRST
        while not self._closed:
            self._event.wait()
            self._event.clear()
            pause = FIRST
            while not (self._closed or self._look()):
                threading.Event().wait(pause)
                pause = min(1.5 * pause, LAST)

    def _look(self) -> bool:
        """Connect it if it is there; whether it is."""
        if self.connected:
            self._meet()
            return True
        try:
            self._port.listen_to(self._topic, self._carrier)
        except (AddressError, UnknownPlugin):
            raise
        except YarpError as error:
            if not self.why:
                log.info("waiting for %s: %s", self._topic, error)
            self.why = str(error)
            return False
        self.why = ""
        self._grant()
        self._meet()
        return True
