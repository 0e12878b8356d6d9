"""DeviceDriver and its like: a device without a view.

Rules: a subclass of DeviceDriver with the members that `yarpy.devices` describes is a device that a
server takes (`PolyDriver.attach`).
"""

from __future__ import annotations

from typing import Any, Self

from yarp._portable import PortReader


class IConfig:
    """An object that can be opened by options, configured and closed."""

    def open(self, config: Any = None) -> bool:
        """Open; a subclass says what that is."""
        return True

    def close(self) -> bool:
        """Close; a subclass says what that is."""
        return True

    def configure(self, config: Any) -> bool:
        """Change options; False for what cannot be changed."""
        return False


class DeviceDriver(IConfig):
    """The base of devices."""

    def __init__(self) -> None:
        self._id = ""

    def id(self) -> str:
        """Return the name that was given."""
        return self._id

    def setId(self, id: str) -> None:
        """Give a name."""
        self._id = id

    def getImplementation(self) -> Self:
        """Return the device itself."""
        return self


class DeprecatedDeviceDriver(DeviceDriver):
    """The base of devices that C++ is about to drop."""


class DeviceResponder(PortReader):
    """Answers requests: a subclass defines `respond(command, reply)`."""

    def __init__(self) -> None:
        self._usage: list[tuple[str, str]] = []

    def addUsage(self, txt: str, explain: str = "") -> None:
        """Say what can be asked."""
        self._usage.append((txt, explain))

    def makeUsage(self) -> None:
        """Forget what was said."""
        self._usage.clear()

    def respond(self, command: Any, reply: Any) -> bool:
        """Answer `help`; a subclass answers the rest."""
        if command.get(0).asString() != "help":
            return False
        for text, explain in self._usage:
            reply.addString(f"{text} {explain}".strip())
        return True

    def read(self, reader: Any) -> bool:
        """Answer what has come."""
        from yarp._bottle import Bottle

        command, reply = Bottle(), Bottle()
        if not command.read(reader):
            return False
        self.respond(command, reply)
        writer = reader.getWriter()
        if writer is not None:
            reply.write(writer)
        return True

    def onRead(self, v: Any) -> None:
        """Answer a request that a port was set to hand over; its answer goes nowhere."""
        from yarp._bottle import Bottle

        self.respond(v, Bottle())

    def attach(self, port: Any) -> None:
        """Answer what a port is asked: `responder.attach(port)` instead of `setReader`."""
        port.setReader(self)
