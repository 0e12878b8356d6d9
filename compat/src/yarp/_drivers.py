"""Drivers and DriverCreator: the devices that PolyDriver opens, by name, and how one is made.

    class Arms(yarp.DriverCreator):
        def create(self): return Arm()
        def getName(self): return "myArm"

    yarp.Drivers.factory().add(Arms())
    driver = yarp.PolyDriver("(device myArm)")

Rules: what a creator makes is a device of Python, with the members that `yarpy.devices` describes;
if it has `open`, that is called with the options. Packages bring types of devices without creators,
by the entry point `yarpy.devices`.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from yarp._device import DeviceDriver


class DriverCreator:
    """Makes devices of a type. Subclasses define `create` and `getName`."""

    def create(self) -> Any:
        """Return a device that is not open yet."""
        raise NotImplementedError(f"{type(self).__name__} has to define create")

    def getName(self) -> str:
        """Return the type: what the option `device` says."""
        raise NotImplementedError(f"{type(self).__name__} has to define getName")

    def getWrapper(self) -> str:
        """Return the type of the server that brings it to the network, "" for none."""
        return ""

    def getCode(self) -> str:
        """Return the name of the class that is made."""
        return ""

    def toString(self) -> str:
        """Return the type."""
        return self.getName()

    toString_c = toString

    def owner(self) -> Any:
        """Return the PolyDriver of which this is a link: none."""
        return None


class StubDriverCreator(DriverCreator):
    """Makes devices by a class, or a function, of a module: `("myArm", "", "Arm", "my.arms",
    "Arm")`. It is imported when the first device is made."""

    def __init__(self, name: str, wrap: str, code: str, libname: str, fnname: str) -> None:
        self._name, self._wrap, self._code = name, wrap, code
        self._place = (libname, fnname)

    def create(self) -> Any:
        """Return a device. Raises ImportError, AttributeError."""
        module, name = self._place
        return getattr(import_module(module), name)()

    def getName(self) -> str:
        return self._name

    def getWrapper(self) -> str:
        return self._wrap

    def getCode(self) -> str:
        return self._code


class _Made(DeviceDriver):
    """A device of a known type, which `open` opens."""

    def __init__(self, name: str) -> None:
        from yarp._poly_driver import PolyDriver

        super().__init__()
        self._name = name
        self._driver = PolyDriver()

    def open(self, config: Any = None) -> bool:
        """Open it by options, of which `device` is known."""
        from yarp._property import Property

        options = Property("" if config is None else config.toString())
        options.put("device", self._name)
        return self._driver.open(options)

    def close(self) -> bool:
        return self._driver.close()

    def getImplementation(self) -> Any:
        """Return the device itself, None while it is not open."""
        return self._driver.getImplementation()


class _Known(DriverCreator):
    """Makes devices of a type that PolyDriver knows."""

    def __init__(self, name: str) -> None:
        self._name = name

    def create(self) -> Any:
        return _Made(self._name)

    def getName(self) -> str:
        return self._name

    def getWrapper(self) -> str:
        from yarp import _network_device
        from yarp._poly_driver import WRAPPERS

        if self._name in WRAPPERS:
            return WRAPPERS[self._name]
        kinds = _network_device.INTERFACES.values()
        return next((each.NWS for each in kinds if self._name == each.FAKE), "")

    def getCode(self) -> str:
        from yarp import _network_device as known

        for table in (known.LOCAL, known.OWN, known.CLIENTS, known.SERVED):
            if self._name in table:
                return str(getattr(table[self._name], "__name__", ""))
        return ""


class Drivers:
    """The devices that PolyDriver opens, by name."""

    @staticmethod
    def factory() -> Drivers:
        """Return the only one."""
        return Drivers()

    def toString(self) -> str:
        """The names of all devices."""
        from yarp._poly_driver import ADDED, DEVICES

        return "\n".join(f"Device {name!r}" for name in sorted({*DEVICES, *ADDED}))

    toString_c = toString

    def find(self, name: str) -> DriverCreator | None:
        """Return what makes devices of a type, None if there is no such type."""
        from yarp._poly_driver import ADDED, DEVICES

        if name in ADDED:
            found: DriverCreator = ADDED[name]
            return found
        return _Known(name) if name in DEVICES else None

    def open(self, config: Any) -> Any:
        """Return a PolyDriver that is open, or None."""
        from yarp._poly_driver import PolyDriver

        driver = PolyDriver()
        return driver if driver.open(config) else None

    def add(self, creator: DriverCreator) -> None:
        """Let PolyDriver open devices of one more type; one of the same name is hidden."""
        from yarp._poly_driver import ADDED

        ADDED[creator.getName()] = creator

    def remove(self, name: str) -> bool:
        """Undo `add`; False if nothing of that name was added."""
        from yarp._poly_driver import ADDED

        return ADDED.pop(name, None) is not None

    def addDeprecatedAlias(self, old_name: str, new_name: str) -> bool:
        """Let a device be opened by another name, too, as it was once called."""
        from yarp._poly_driver import ALIASES, DEVICES

        if new_name not in DEVICES or old_name in DEVICES:
            return False
        ALIASES[old_name] = new_name
        return True

    @staticmethod
    def yarpdev(argc: int, argv: list[str]) -> int:
        """Be the program `yarpdev`, whose name is the first argument, until it is asked to end;
        return its exit code."""
        from yarp._yarpdev import run

        return run([*argv][1:argc])
