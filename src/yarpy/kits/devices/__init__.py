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

if TYPE_CHECKING:
    from yarpy.kits.devices.analog.client import AnalogSensor as AnalogSensor
    from yarpy.kits.devices.analog.server import AnalogSensorServer as AnalogSensorServer
    from yarpy.kits.devices.analog.virtual import VirtualAnalogServer as VirtualAnalogServer
    from yarpy.kits.devices.battery.client import Battery as Battery
    from yarpy.kits.devices.battery.interface import BATTERY as BATTERY
    from yarpy.kits.devices.battery.server import BatteryServer as BatteryServer
    from yarpy.kits.devices.control_board.client import ControlBoard as ControlBoard
    from yarpy.kits.devices.control_board.interface import ControlMode as ControlMode
    from yarpy.kits.devices.control_board.interface import Gains as Gains
    from yarpy.kits.devices.control_board.interface import InteractionMode as InteractionMode
    from yarpy.kits.devices.control_board.interface import (
        MotorTorqueParameters as MotorTorqueParameters,
    )
    from yarpy.kits.devices.control_board.remap import remap as remap
    from yarpy.kits.devices.control_board.remap import remap_remote as remap_remote
    from yarpy.kits.devices.control_board.server import ControlBoardServer as ControlBoardServer
    from yarpy.kits.devices.controllers.cartesian import CartesianController as CartesianController
    from yarpy.kits.devices.controllers.cartesian_server import CartesianServer as CartesianServer
    from yarpy.kits.devices.controllers.gaze import GazeController as GazeController
    from yarpy.kits.devices.controllers.gaze_server import GazeServer as GazeServer
    from yarpy.kits.devices.frame_grabber.client import FrameGrabber as FrameGrabber
    from yarpy.kits.devices.frame_grabber.interface import FEATURES as FEATURES
    from yarpy.kits.devices.frame_grabber.server import FrameGrabberServer as FrameGrabberServer
    from yarpy.kits.devices.frame_grabber.writer import FrameWriterServer as FrameWriterServer
    from yarpy.kits.devices.interfaces.audio import AudioPlayer as AudioPlayer
    from yarpy.kits.devices.interfaces.audio import AudioRecorder as AudioRecorder
    from yarpy.kits.devices.interfaces.depth import DepthCamera as DepthCamera
    from yarpy.kits.devices.interfaces.grid import Grid as Grid
    from yarpy.kits.devices.interfaces.grid_file import load_grid as load_grid
    from yarpy.kits.devices.interfaces.grid_file import save_grid as save_grid
    from yarpy.kits.devices.interfaces.joypad import Joypad as Joypad
    from yarpy.kits.devices.interfaces.joypad import JoypadState as JoypadState
    from yarpy.kits.devices.interfaces.localization import Localization2D as Localization2D
    from yarpy.kits.devices.interfaces.map2d import Map2D as Map2D
    from yarpy.kits.devices.interfaces.mobile_base import MobileBase as MobileBase
    from yarpy.kits.devices.interfaces.mobile_base import Odometry2D as Odometry2D
    from yarpy.kits.devices.interfaces.navigation import Navigation2D as Navigation2D
    from yarpy.kits.devices.interfaces.place import Area as Area
    from yarpy.kits.devices.interfaces.place import Odometry as Odometry
    from yarpy.kits.devices.interfaces.place import Path as Path
    from yarpy.kits.devices.interfaces.place import Place as Place
    from yarpy.kits.devices.interfaces.place import Thing as Thing
    from yarpy.kits.devices.interfaces.serial import SerialPort as SerialPort
    from yarpy.kits.devices.interfaces.speech import SpeechSynthesizer as SpeechSynthesizer
    from yarpy.kits.devices.interfaces.speech import SpeechTranscription as SpeechTranscription
    from yarpy.kits.devices.interfaces.talk import ChatBot as ChatBot
    from yarpy.kits.devices.interfaces.talk import LanguageModel as LanguageModel
    from yarpy.kits.devices.interfaces.talk import Line as Line
    from yarpy.kits.devices.interfaces.world import Colour as Colour
    from yarpy.kits.devices.interfaces.world import Description as Description
    from yarpy.kits.devices.interfaces.world import Descriptions as Descriptions
    from yarpy.kits.devices.interfaces.world import Pose as Pose
    from yarpy.kits.devices.interfaces.world import World as World
    from yarpy.kits.devices.laser.client import Laser as Laser
    from yarpy.kits.devices.laser.interface import Scan as Scan
    from yarpy.kits.devices.laser.server import LaserServer as LaserServer
    from yarpy.kits.devices.multi_sensor.client import MultiSensor as MultiSensor
    from yarpy.kits.devices.multi_sensor.server import MultiSensorServer as MultiSensorServer
    from yarpy.kits.devices.network.model import Interface as Interface
    from yarpy.kits.devices.refusal import Refused as Refused
    from yarpy.kits.devices.simulated.analog import SimulatedAnalogSensor as SimulatedAnalogSensor
    from yarpy.kits.devices.simulated.arm import SimulatedArm as SimulatedArm
    from yarpy.kits.devices.simulated.audio import SimulatedMicrophone as SimulatedMicrophone
    from yarpy.kits.devices.simulated.audio import SimulatedSpeaker as SimulatedSpeaker
    from yarpy.kits.devices.simulated.base import SimulatedBase as SimulatedBase
    from yarpy.kits.devices.simulated.battery import SimulatedBattery as SimulatedBattery
    from yarpy.kits.devices.simulated.camera import SimulatedCamera as SimulatedCamera
    from yarpy.kits.devices.simulated.coupling import SimulatedCoupling as SimulatedCoupling
    from yarpy.kits.devices.simulated.depth_camera import (
        SimulatedDepthCamera as SimulatedDepthCamera,
    )
    from yarpy.kits.devices.simulated.frame_writer import (
        SimulatedFrameWriter as SimulatedFrameWriter,
    )
    from yarpy.kits.devices.simulated.head import SimulatedHead as SimulatedHead
    from yarpy.kits.devices.simulated.imu import SimulatedImu as SimulatedImu
    from yarpy.kits.devices.simulated.joints import SimulatedJoints as SimulatedJoints
    from yarpy.kits.devices.simulated.joypad import SimulatedJoypad as SimulatedJoypad
    from yarpy.kits.devices.simulated.laser import SimulatedLaser as SimulatedLaser
    from yarpy.kits.devices.simulated.localized_laser import LocalizedLaser as LocalizedLaser
    from yarpy.kits.devices.simulated.map_storage import MapStorage as MapStorage
    from yarpy.kits.devices.simulated.position_sensor import (
        SimulatedPositionSensor as SimulatedPositionSensor,
    )
    from yarpy.kits.devices.simulated.serial import SimulatedSerialPort as SimulatedSerialPort
    from yarpy.kits.devices.simulated.speech import SimulatedSynthesizer as SimulatedSynthesizer
    from yarpy.kits.devices.simulated.speech import SimulatedTranscription as SimulatedTranscription
    from yarpy.kits.devices.simulated.talk import SimulatedChatBot as SimulatedChatBot
    from yarpy.kits.devices.simulated.talk import SimulatedLanguageModel as SimulatedLanguageModel
    from yarpy.kits.devices.simulated.world import DescriptionStorage as DescriptionStorage
    from yarpy.kits.devices.simulated.world import SimulatedWorld as SimulatedWorld
    from yarpy.kits.devices.transforms.client import TransformClient as TransformClient
    from yarpy.kits.devices.transforms.server import TransformServer as TransformServer
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
        "simulated.base": "SimulatedBase",
        "simulated.battery": "SimulatedBattery",
        "simulated.camera": "SimulatedCamera",
        "simulated.coupling": "SimulatedCoupling",
        "simulated.depth_camera": "SimulatedDepthCamera",
        "simulated.frame_writer": "SimulatedFrameWriter",
        "simulated.head": "SimulatedHead",
        "simulated.imu": "SimulatedImu",
        "simulated.joints": "SimulatedJoints",
        "simulated.joypad": "SimulatedJoypad",
        "simulated.laser": "SimulatedLaser",
        "simulated.localized_laser": "LocalizedLaser",
        "simulated.map_storage": "MapStorage",
        "simulated.position_sensor": "SimulatedPositionSensor",
        "simulated.serial": "SimulatedSerialPort",
        "simulated.speech": "SimulatedSynthesizer SimulatedTranscription",
        "simulated.talk": "SimulatedChatBot SimulatedLanguageModel",
        "simulated.world": "DescriptionStorage SimulatedWorld",
        "transforms.client": "TransformClient",
        "transforms.server": "TransformServer",
    }
    _WHERE = {name: module for module, names in _NAMES.items() for name in names.split()}
    __all__ = sorted(_WHERE)

    def __getattr__(name):
        module = _WHERE.get(name)
        if module is None:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"yarpy.kits.devices.{module}"), name)
        globals()[name] = value
        return value

    def __dir__():
        return sorted({*globals(), *__all__})
