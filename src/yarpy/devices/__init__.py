"""Robot devices over ports: control boards, cameras, sensors - serve your own, use others'.

    control_board       motors and encoders of joints
    frame_grabber       cameras
    multi_sensor        sensors, such as inertial units
    battery             batteries
    laser               laser scanners
    transforms          frames, and where they are

Each folder has `interface` (what your class may have), `server` (serves it on ports) and `client`
(uses a remote one); next to the folders is what they share. The names below can be imported from
here; each module is loaded when its name is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

_WHERE = {
    "BATTERY": "battery.interface",
    "Battery": "battery.client",
    "BatteryServer": "battery.server",
    "ControlBoard": "control_board.client",
    "ControlBoardServer": "control_board.server",
    "ControlMode": "control_board.interface",
    "FEATURES": "frame_grabber.interface",
    "FrameGrabber": "frame_grabber.client",
    "FrameGrabberServer": "frame_grabber.server",
    "Gains": "control_board.interface",
    "InteractionMode": "control_board.interface",
    "Laser": "laser.client",
    "LaserServer": "laser.server",
    "MotorTorqueParameters": "control_board.interface",
    "MultiSensor": "multi_sensor.client",
    "MultiSensorServer": "multi_sensor.server",
    "Scan": "laser.interface",
    "TransformClient": "transforms.client",
    "TransformServer": "transforms.server",
}

__all__ = [*_WHERE]

if TYPE_CHECKING:
    from yarpy.devices.battery.client import Battery as Battery
    from yarpy.devices.battery.interface import BATTERY as BATTERY
    from yarpy.devices.battery.server import BatteryServer as BatteryServer
    from yarpy.devices.control_board.client import ControlBoard as ControlBoard
    from yarpy.devices.control_board.interface import ControlMode as ControlMode
    from yarpy.devices.control_board.interface import Gains as Gains
    from yarpy.devices.control_board.interface import InteractionMode as InteractionMode
    from yarpy.devices.control_board.interface import MotorTorqueParameters as MotorTorqueParameters
    from yarpy.devices.control_board.server import ControlBoardServer as ControlBoardServer
    from yarpy.devices.frame_grabber.client import FrameGrabber as FrameGrabber
    from yarpy.devices.frame_grabber.interface import FEATURES as FEATURES
    from yarpy.devices.frame_grabber.server import FrameGrabberServer as FrameGrabberServer
    from yarpy.devices.laser.client import Laser as Laser
    from yarpy.devices.laser.interface import Scan as Scan
    from yarpy.devices.laser.server import LaserServer as LaserServer
    from yarpy.devices.multi_sensor.client import MultiSensor as MultiSensor
    from yarpy.devices.multi_sensor.server import MultiSensorServer as MultiSensorServer
    from yarpy.devices.transforms.client import TransformClient as TransformClient
    from yarpy.devices.transforms.server import TransformServer as TransformServer


def __getattr__(name: str) -> Any:
    module = _WHERE.get(name)
    if module is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"yarpy.devices.{module}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
