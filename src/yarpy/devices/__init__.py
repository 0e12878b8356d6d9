"""Robot devices over ports: control boards, cameras, sensors - yours as a server, others as client.

The names below can be imported from here; each module is loaded when its name is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

_WHERE = {
    "ControlBoard": "control_board_client",
    "ControlBoardServer": "control_board_server",
    "ControlMode": "control_board",
    "FEATURES": "frame_grabber",
    "FrameGrabber": "frame_grabber_client",
    "FrameGrabberServer": "frame_grabber_server",
    "Gains": "control_board",
    "InteractionMode": "control_board",
    "MotorTorqueParameters": "control_board",
    "MultiSensor": "multi_sensor_client",
    "MultiSensorServer": "multi_sensor_server",
}

__all__ = [*_WHERE]

if TYPE_CHECKING:
    from yarpy.devices.control_board import ControlMode as ControlMode
    from yarpy.devices.control_board import Gains as Gains
    from yarpy.devices.control_board import InteractionMode as InteractionMode
    from yarpy.devices.control_board import MotorTorqueParameters as MotorTorqueParameters
    from yarpy.devices.control_board_client import ControlBoard as ControlBoard
    from yarpy.devices.control_board_server import ControlBoardServer as ControlBoardServer
    from yarpy.devices.frame_grabber import FEATURES as FEATURES
    from yarpy.devices.frame_grabber_client import FrameGrabber as FrameGrabber
    from yarpy.devices.frame_grabber_server import FrameGrabberServer as FrameGrabberServer
    from yarpy.devices.multi_sensor_client import MultiSensor as MultiSensor
    from yarpy.devices.multi_sensor_server import MultiSensorServer as MultiSensorServer


def __getattr__(name: str) -> Any:
    module = _WHERE.get(name)
    if module is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"yarpy.devices.{module}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
