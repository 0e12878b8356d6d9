"""Robot devices over ports: control boards, cameras, sensors - serve your own, use others'.

    control_board       motors and encoders of joints
    frame_grabber       cameras
    multi_sensor        sensors, such as inertial units
    battery             batteries
    laser               laser scanners
    analog              sensors with channels, as older robots have them
    transforms          frames, and where they are
    controllers         where a hand is, and where a head looks

    interfaces          all others: bases, navigation, maps ...
    simulated           devices without hardware

Each of the first has `interface` (what your class may have), `server` (serves it on ports) and
`client` (uses a remote one). An interface of the others is one class, whose server and client are
made from it (`network`). Next to the folders is what they share. The names below can be imported
from here; each module is loaded when its name is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

__all__ = [
    "BATTERY", "FEATURES", "AnalogSensor", "AnalogSensorServer", "Area", "AudioPlayer",
    "AudioRecorder", "Battery", "BatteryServer", "CartesianController", "CartesianServer",
    "ChatBot", "Colour", "ControlBoard", "ControlBoardServer", "ControlMode", "DepthCamera",
    "Description", "DescriptionStorage", "Descriptions", "FrameGrabber", "FrameGrabberServer",
    "FrameWriterServer", "Gains", "GazeController", "GazeServer", "Grid", "InteractionMode",
    "Interface", "Joypad", "JoypadState", "LanguageModel", "Laser", "LaserServer", "Line",
    "Localization2D", "LocalizedLaser", "Map2D", "MapStorage", "MobileBase",
    "MotorTorqueParameters", "MultiSensor", "MultiSensorServer", "Navigation2D", "Odometry",
    "Odometry2D", "Path", "Place", "Pose", "Refused", "Scan", "SerialPort",
    "SimulatedAnalogSensor", "SimulatedArm", "SimulatedBase", "SimulatedBattery",
    "SimulatedCamera", "SimulatedChatBot", "SimulatedCoupling", "SimulatedDepthCamera",
    "SimulatedFrameWriter", "SimulatedHead", "SimulatedImu", "SimulatedJoints",
    "SimulatedJoypad", "SimulatedLanguageModel", "SimulatedLaser", "SimulatedMicrophone",
    "SimulatedPositionSensor", "SimulatedSerialPort", "SimulatedSpeaker",
    "SimulatedSynthesizer", "SimulatedTranscription", "SimulatedWorld", "SpeechSynthesizer",
    "SpeechTranscription", "Thing", "TransformClient", "TransformServer", "VirtualAnalogServer",
    "World", "load_grid", "remap", "remap_remote", "save_grid",
]  # fmt: skip

if TYPE_CHECKING:
    from yarpy.kits.devices.analog.client import AnalogSensor
    from yarpy.kits.devices.analog.server import AnalogSensorServer
    from yarpy.kits.devices.analog.virtual import VirtualAnalogServer
    from yarpy.kits.devices.battery.client import Battery
    from yarpy.kits.devices.battery.interface import BATTERY
    from yarpy.kits.devices.battery.server import BatteryServer
    from yarpy.kits.devices.control_board.client import ControlBoard
    from yarpy.kits.devices.control_board.interface import (
        ControlMode,
        Gains,
        InteractionMode,
        MotorTorqueParameters,
    )
    from yarpy.kits.devices.control_board.remap import remap, remap_remote
    from yarpy.kits.devices.control_board.server import ControlBoardServer
    from yarpy.kits.devices.controllers.cartesian import CartesianController
    from yarpy.kits.devices.controllers.cartesian_server import CartesianServer
    from yarpy.kits.devices.controllers.gaze import GazeController
    from yarpy.kits.devices.controllers.gaze_server import GazeServer
    from yarpy.kits.devices.frame_grabber.client import FrameGrabber
    from yarpy.kits.devices.frame_grabber.interface import FEATURES
    from yarpy.kits.devices.frame_grabber.server import FrameGrabberServer
    from yarpy.kits.devices.frame_grabber.writer import FrameWriterServer
    from yarpy.kits.devices.interfaces.audio import AudioPlayer, AudioRecorder
    from yarpy.kits.devices.interfaces.depth import DepthCamera
    from yarpy.kits.devices.interfaces.grid import Grid
    from yarpy.kits.devices.interfaces.grid_file import load_grid, save_grid
    from yarpy.kits.devices.interfaces.joypad import Joypad, JoypadState
    from yarpy.kits.devices.interfaces.localization import Localization2D
    from yarpy.kits.devices.interfaces.map2d import Map2D
    from yarpy.kits.devices.interfaces.mobile_base import MobileBase, Odometry2D
    from yarpy.kits.devices.interfaces.navigation import Navigation2D
    from yarpy.kits.devices.interfaces.place import Area, Odometry, Path, Place, Thing
    from yarpy.kits.devices.interfaces.serial import SerialPort
    from yarpy.kits.devices.interfaces.speech import SpeechSynthesizer, SpeechTranscription
    from yarpy.kits.devices.interfaces.talk import ChatBot, LanguageModel, Line
    from yarpy.kits.devices.interfaces.world import Colour, Description, Descriptions, Pose, World
    from yarpy.kits.devices.laser.client import Laser
    from yarpy.kits.devices.laser.interface import Scan
    from yarpy.kits.devices.laser.server import LaserServer
    from yarpy.kits.devices.multi_sensor.client import MultiSensor
    from yarpy.kits.devices.multi_sensor.server import MultiSensorServer
    from yarpy.kits.devices.network.model import Interface
    from yarpy.kits.devices.refusal import Refused
    from yarpy.kits.devices.simulated.analog import SimulatedAnalogSensor
    from yarpy.kits.devices.simulated.arm import SimulatedArm
    from yarpy.kits.devices.simulated.audio import SimulatedMicrophone, SimulatedSpeaker
    from yarpy.kits.devices.simulated.battery import SimulatedBattery
    from yarpy.kits.devices.simulated.camera import SimulatedCamera
    from yarpy.kits.devices.simulated.coupling import SimulatedCoupling
    from yarpy.kits.devices.simulated.depth_camera import SimulatedDepthCamera
    from yarpy.kits.devices.simulated.frame_writer import SimulatedFrameWriter
    from yarpy.kits.devices.simulated.head import SimulatedHead
    from yarpy.kits.devices.simulated.imu import SimulatedImu
    from yarpy.kits.devices.simulated.joints import SimulatedJoints
    from yarpy.kits.devices.simulated.joypad import SimulatedJoypad
    from yarpy.kits.devices.simulated.navigation.base import SimulatedBase
    from yarpy.kits.devices.simulated.navigation.laser import SimulatedLaser
    from yarpy.kits.devices.simulated.navigation.localized_laser import LocalizedLaser
    from yarpy.kits.devices.simulated.navigation.map_storage import MapStorage
    from yarpy.kits.devices.simulated.position_sensor import SimulatedPositionSensor
    from yarpy.kits.devices.simulated.serial import SimulatedSerialPort
    from yarpy.kits.devices.simulated.speech import SimulatedSynthesizer, SimulatedTranscription
    from yarpy.kits.devices.simulated.talk import SimulatedChatBot, SimulatedLanguageModel
    from yarpy.kits.devices.simulated.world import DescriptionStorage, SimulatedWorld
    from yarpy.kits.devices.transforms.client import TransformClient
    from yarpy.kits.devices.transforms.server import TransformServer
else:
    # Type checkers do not see this: with the function below every name would be right.
    _NAMES = {
        "analog.client": "AnalogSensor",
        "analog.server": "AnalogSensorServer",
        "analog.virtual": "VirtualAnalogServer",
        "battery.client": "Battery",
        "battery.interface": "BATTERY",
        "battery.server": "BatteryServer",
        "control_board.client": "ControlBoard",
        "control_board.interface": "ControlMode Gains InteractionMode MotorTorqueParameters",
        "control_board.remap": "remap remap_remote",
        "control_board.server": "ControlBoardServer",
        "controllers.cartesian": "CartesianController",
        "controllers.cartesian_server": "CartesianServer",
        "controllers.gaze": "GazeController",
        "controllers.gaze_server": "GazeServer",
        "frame_grabber.client": "FrameGrabber",
        "frame_grabber.interface": "FEATURES",
        "frame_grabber.server": "FrameGrabberServer",
        "frame_grabber.writer": "FrameWriterServer",
        "interfaces.audio": "AudioPlayer AudioRecorder",
        "interfaces.depth": "DepthCamera",
        "interfaces.grid": "Grid",
        "interfaces.grid_file": "load_grid save_grid",
        "interfaces.joypad": "Joypad JoypadState",
        "interfaces.localization": "Localization2D",
        "interfaces.map2d": "Map2D",
        "interfaces.mobile_base": "MobileBase Odometry2D",
        "interfaces.navigation": "Navigation2D",
        "interfaces.place": "Area Odometry Path Place Thing",
        "interfaces.serial": "SerialPort",
        "interfaces.speech": "SpeechSynthesizer SpeechTranscription",
        "interfaces.talk": "ChatBot LanguageModel Line",
        "interfaces.world": "Colour Description Descriptions Pose World",
        "laser.client": "Laser",
        "laser.interface": "Scan",
        "laser.server": "LaserServer",
        "multi_sensor.client": "MultiSensor",
        "multi_sensor.server": "MultiSensorServer",
        "network.model": "Interface",
        "refusal": "Refused",
        "simulated.analog": "SimulatedAnalogSensor",
        "simulated.arm": "SimulatedArm",
        "simulated.audio": "SimulatedMicrophone SimulatedSpeaker",
        "simulated.navigation.base": "SimulatedBase",
        "simulated.battery": "SimulatedBattery",
        "simulated.camera": "SimulatedCamera",
        "simulated.coupling": "SimulatedCoupling",
        "simulated.depth_camera": "SimulatedDepthCamera",
        "simulated.frame_writer": "SimulatedFrameWriter",
        "simulated.head": "SimulatedHead",
        "simulated.imu": "SimulatedImu",
        "simulated.joints": "SimulatedJoints",
        "simulated.joypad": "SimulatedJoypad",
        "simulated.navigation.laser": "SimulatedLaser",
        "simulated.navigation.localized_laser": "LocalizedLaser",
        "simulated.navigation.map_storage": "MapStorage",
        "simulated.position_sensor": "SimulatedPositionSensor",
        "simulated.serial": "SimulatedSerialPort",
        "simulated.speech": "SimulatedSynthesizer SimulatedTranscription",
        "simulated.talk": "SimulatedChatBot SimulatedLanguageModel",
        "simulated.world": "DescriptionStorage SimulatedWorld",
        "transforms.client": "TransformClient",
        "transforms.server": "TransformServer",
    }
    _WHERE = {name: module for module, names in _NAMES.items() for name in names.split()}

    def __getattr__(name):
        module = _WHERE.get(name)
        if module is None:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"yarpy.kits.devices.{module}"), name)
        globals()[name] = value
        return value

    def __dir__():
        return sorted({*globals(), *__all__})
