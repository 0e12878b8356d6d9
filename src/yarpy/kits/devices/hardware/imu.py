"""SerialImu: an inertial unit on a serial line, as sensors.

    <device name="imu" type="witmotionImu"><param name="port">/dev/ttyUSB0</param></device>

    yarpy dev witmotionImu --port /dev/ttyUSB0 --baud 9600 --name /imu
    yarpy dev xsensImu --port /dev/ttyUSB0 --baud 115200 --name /imu

Rules: it has the members of `multi_sensor.interface`. It is only listened to: what it sends is set
with its maker's program. What it has is what comes within `LISTENED` of the first packet; after
`SILENT` without any, reading fails.
"""

from __future__ import annotations

import threading
import time
from contextlib import ExitStack
from typing import Final

from yarpy.data.bottle import Property
from yarpy.errors import Timeout
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware.imu_packet import Split, witmotion, xsens
from yarpy.kits.devices.hardware.line import Line
from yarpy.log import logger
from yarpy.names.base import NameClient

log = logger("yarpy.devices")

FIRST: Final = 3.0  # seconds for the first packet
LISTENED: Final = 1.0  # seconds from there until it is known what comes
SILENT: Final = 1.0
_LOOK: Final = 0.1  # seconds between looks whether it is closed
_WITMOTION_BAUD, _XSENS_BAUD = 9600, 115_200  # as they come from their makers


class SerialImu(Closeable):
    """The unit on the line at `port`; `split` knows its packets. name, frame: of all its sensors.

    Raises OSError (no such line), Timeout (nothing comes that it understands), UnknownPlugin (no
    pyserial).
    """

    def __init__(
        self, split: Split, port: str, baud: int, name: str = "imu", frame: str = ""
    ) -> None:
        self.frames = {name: frame or name}
        self._name, self._split, self._rest = name, split, b""
        self._values: dict[str, tuple[float, ...]] = {}
        self._time, self._came = 0.0, 0.0
        self._over = threading.Event()
        with ExitStack() as resources:
            self._line = resources.enter_context(Line(port, baud))
            self._listen(time.monotonic() + FIRST, once=True)
            if not self._values:
                raise Timeout(
                    f"{port}: no packet came within {FIRST} s: is it on, and is {baud} its speed "
                    "(--baud)?"
                )
            self._listen(time.monotonic() + LISTENED)
            self._kinds = frozenset(self._values)
            thread = threading.Thread(target=self._run, name=f"yarpy device {port}", daemon=True)
            thread.start()
            resources.callback(thread.join, 5.0)
            resources.callback(self._over.set)
            self._resources = resources.pop_all()

    def gyroscopes(self) -> dict[str, tuple[float, ...]]:
        """Degrees per second. Raises Timeout."""
        return self._read("gyroscopes")

    def accelerometers(self) -> dict[str, tuple[float, ...]]:
        """m/s^2. Raises Timeout."""
        return self._read("accelerometers")

    def orientations(self) -> dict[str, tuple[float, ...]]:
        """Roll, pitch and yaw, degrees. Raises Timeout."""
        return self._read("orientations")

    def thermometers(self) -> dict[str, tuple[float, ...]]:
        """Degrees Celsius. Raises Timeout."""
        return self._read("thermometers")

    def timestamps(self) -> dict[str, float]:
        """Return the time when the last packet came, seconds."""
        return {self._name: self._time}

    def _read(self, kind: str) -> dict[str, tuple[float, ...]]:
        if kind not in self._kinds:
            return {}
        if time.monotonic() - self._came > SILENT:
            raise Timeout(f"{self._line.path}: nothing comes any more")
        return {self._name: self._values[kind]}

    def _listen(self, until: float, *, once: bool = False) -> None:
        while time.monotonic() < until and not (once and self._values):
            self._take(until)

    def _run(self) -> None:
        try:
            while not self._over.is_set():
                self._take(time.monotonic() + _LOOK)
        except OSError as error:
            log.warning("%s: %s: is it plugged in?", self._line.path, error)

    def _take(self, until: float) -> None:
        readings, self._rest = self._split(self._rest + self._line.read(until))
        if readings:
            self._values |= dict(readings)
            self._time, self._came = time.time(), time.monotonic()


def witmotion_imu(options: Property, *, names: NameClient | None = None) -> object:
    """An inertial unit of WitMotion. Raises ValueError, OSError, YarpError."""
    return _opened(witmotion, _WITMOTION_BAUD, options)


def xsens_imu(options: Property, *, names: NameClient | None = None) -> object:
    """An MTi of Xsens. Raises ValueError, OSError, YarpError."""
    return _opened(xsens, _XSENS_BAUD, options)


def _opened(split: Split, usual: int, options: Property) -> SerialImu:
    port, baud = str(options.find("port", "") or ""), options.find("baud", usual)
    if not port:
        raise ValueError("it needs the parameter port, a serial line such as /dev/ttyUSB0")
    if type(baud) is not int:
        raise ValueError(f"baud {baud} is no number")
    name, frame = (str(options.find(key, "") or "") for key in ("sensorName", "frameName"))
    return SerialImu(split, port, baud, name or "imu", frame)
