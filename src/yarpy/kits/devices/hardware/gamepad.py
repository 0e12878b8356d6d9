"""Gamepad: gamepads and joysticks of Linux, without a library.

    <device name="pad" type="gamepad"><param name="port">/dev/input/js0</param></device>

    yarpy dev gamepad --name /pad

Rules: it has the axes and buttons that the system tells, -1 to 1 and 0 or 1; hats are axes there.
What it tells when it is opened is known at once. After it is unplugged, everything is at rest.

Source: Documentation/input/joydev of Linux.
"""

from __future__ import annotations

import os
import selectors
import sys
import threading
from contextlib import ExitStack
from struct import Struct
from typing import Final

from yarpy.data.bottle import Property
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware.device_file import open_device
from yarpy.kits.devices.interfaces.joypad import JoypadState
from yarpy.kits.devices.simulated.joypad import SimulatedJoypad
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.transports.descriptor import has_input

log = logger("yarpy.devices")

#: milliseconds, value, kind, number
EVENT: Final = Struct("<IhBB")
BUTTON, AXIS = 1, 2
#: the bit of events that tell how things are, when it is opened
BEGINNING: Final = 0x80
LARGEST: Final = 32767


class Gamepad(SimulatedJoypad, Closeable):
    """The gamepad at `path`; its state changes as it is used. Raises OSError,
    UnknownPlugin on Windows."""

    def __init__(self, path: str = "/dev/input/js0") -> None:
        super().__init__(JoypadState())
        self.path = path
        self._buttons: list[float] = []
        self._axes: list[float] = []
        self._rest = b""
        self._file: int
        self._wake: int
        with ExitStack() as resources:
            self._file = _opened(path)
            resources.callback(os.close, self._file)
            self._wake, end = os.pipe()
            resources.callback(os.close, self._wake)
            while has_input(self._file, 0.0) and self._take():
                pass
            thread = threading.Thread(target=self._run, name=f"yarpy device {path}", daemon=True)
            thread.start()
            resources.callback(thread.join, 5.0)
            resources.callback(os.close, end)
            self._resources = resources.pop_all()

    def _run(self) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(self._wake, selectors.EVENT_READ)
            selector.register(self._file, selectors.EVENT_READ)
            while all(key.fd != self._wake for key, _ in selector.select()):
                if not self._take():
                    log.warning("%s: nothing is plugged in there any more", self.path)
                    self._show([0.0] * len(self._buttons), [0.0] * len(self._axes))
                    return

    def _take(self) -> bool:
        """Take what the system tells; False once it is unplugged."""
        try:
            found = os.read(self._file, 64 * EVENT.size)
        except BlockingIOError:
            return True
        except OSError:
            return False
        data = self._rest + found
        whole = len(data) // EVENT.size * EVENT.size
        for _, value, kind, number in EVENT.iter_unpack(data[:whole]):
            if kind & ~BEGINNING == BUTTON:
                _put(self._buttons, number, float(value != 0))
            elif kind & ~BEGINNING == AXIS:
                _put(self._axes, number, max(value / LARGEST, -1.0))
        self._rest = data[whole:]
        self._show(self._buttons, self._axes)
        return bool(found)

    def _show(self, buttons: list[float], axes: list[float]) -> None:
        self.state = JoypadState(buttons=[*buttons], axes=[*axes])


def gamepad(options: Property, *, names: NameClient | None = None) -> object:
    """A gamepad or joystick of Linux. Raises OSError."""
    return Gamepad(str(options.find("port", "") or "/dev/input/js0"))


def _opened(path: str) -> int:
    if sys.platform == "win32":
        raise UnknownPlugin("gamepads are files of Linux; Windows has none")
    return open_device(
        path,
        os.O_RDONLY | os.O_NONBLOCK,
        "gamepad",
        others="js*",
        option="--port",
        absent="plug one in, or pair it",
        group="input",
    )


def _put(values: list[float], number: int, value: float) -> None:
    values.extend([0.0] * (number + 1 - len(values)))
    values[number] = value
