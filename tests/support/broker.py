"""A broker of mosquitto on the loopback, for tests of MQTT.

Rules: a free port number, no stored messages; it ends with `stop`. A test that has one
declares the peer `mosquitto`.
"""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

from support.peer import program
from support.port import free_port
from support.process import Process
from support.wait import wait_until


class Broker:
    """A broker of mosquitto, to be stopped and started."""

    def __init__(self, folder: Path, *settings: str) -> None:
        self.port = free_port()
        self._config = folder / "mosquitto.conf"
        lines = (f"listener {self.port} 127.0.0.1", "allow_anonymous true", *settings)
        self._config.write_text("\n".join(lines) + "\n")
        self.process: Any = None
        self.start()

    def start(self) -> None:
        self.process = Process([program("mosquitto"), "-c", str(self._config)])
        self.process.__enter__()
        wait_until(self.answers)

    def stop(self) -> None:
        self.process.__exit__(None, None, None)

    def answers(self) -> bool:
        try:
            socket.create_connection(("127.0.0.1", self.port), 1.0).close()
        except OSError:
            return False
        return True

    def topic(self, name: str, added: str = "") -> str:
        return f"mqtt{added}://127.0.0.1:{self.port}/{name}"
