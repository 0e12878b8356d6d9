"""DeviceDriver and Drivers: a device without a view, and what there is to open.

Rules: a subclass of DeviceDriver with the members that `yarpy.devices` describes is a device that a
server takes (`PolyDriver.attach`); devices of Python have no factories.
"""

from __future__ import annotations

from typing import Any, Self

from yarp._portable import PortReader
from yarp._refusal import refuses


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


class Drivers:
    """The devices that PolyDriver opens, by name."""

    @staticmethod
    def factory() -> Drivers:
        """Return the only one."""
        return Drivers()

    def toString(self) -> str:
        """The names of all devices."""
        from yarp._poly_driver import DEVICES

        return "\n".join(f"Device {name!r}" for name in sorted(DEVICES))

    toString_c = toString

    def find(self, name: str) -> str | None:
        """Return the name if there is such a device, else None."""
        from yarp._poly_driver import DEVICES

        return name if name in DEVICES else None

    def open(self, config: Any) -> Any:
        """Return a PolyDriver that is open, or None."""
        from yarp._poly_driver import PolyDriver

        driver = PolyDriver()
        return driver if driver.open(config) else None

    @refuses
    def add(self, creator: Any) -> None:
        """Refuse: devices of Python are served by `PolyDriver.attach`."""
        raise NotImplementedError(
            "a class of yours is a device without a factory: "
            'yarp.PolyDriver("(device controlBoard_nws_yarp) (name /arm)").attach(Arm())'
        )

    def remove(self, name: str) -> bool:
        """Nothing was added, so nothing is removed."""
        return False

    def addDeprecatedAlias(self, old_name: str, new_name: str) -> bool:
        """Let a device be opened by another name, too, as it was once called."""
        from yarp._poly_driver import ALIASES, DEVICES

        if new_name not in DEVICES or old_name in DEVICES:
            return False
        ALIASES[old_name] = new_name
        return True

    @refuses
    def yarpdev(self, argc: int, argv: Any) -> int:
        """Refuse: the command is `yarpdev`."""
        raise NotImplementedError("yarpdev is a command of yarpy-compat: yarpdev --device NAME")
