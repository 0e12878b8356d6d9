"""The types of devices that ship with yarpy, by the names of C++: rows of `shipped.py`.

Rules: a table, nothing else, as there. A type is without hardware, serves another device, is the
client of one in another program, or hardware, whose types have names of their own.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from yarpy.facts import Row

_SIMULATED: Final = (
    *("fakeBattery", "fakeChatBotDevice", "fakeJointCoupling", "fakeJoypad", "fakeLLMDevice"),
    *("fakeLocalizer", "fakeMicrophone", "fakeNavigation", "fakeOdometry2D", "fakePositionSensor"),
    *("fakeSerialPort", "fakeSimulatedWorld", "fakeSpeaker", "fakeSpeechSynthesizer"),
    *("fakeSpeechTranscription", "robotDescriptionStorage"),
)
_KINDS: Final = (
    *("LLM", "RGBDSensor", "audioRecorder", "chatBot", "JoypadControl", "localization2D", "map2D"),
    *("mobileBaseVelocityControl", "navigation2D", "odometry2D", "robotDescription"),
    *("serialPort", "simulatedWorld", "speechSynthesizer", "speechTranscription"),
)
_SERVERS: Final = (
    *(f"{kind}_nws_yarp" for kind in _KINDS),
    *("AudioPlayerWrapper", "JoypadControlServer", "rgbdSensor_nws_yarp"),
)
_CLIENTS: Final = (
    *(f"{kind}_nwc_yarp" for kind in _KINDS),
    *("battery_nwc_yarp", "controlBoard_nwc_yarp", "frameGrabber_nwc_yarp"),
    *("rangefinder2D_nwc_yarp", "JoypadControlClient", "RGBDSensorClient", "RemoteFrameGrabber"),
    *("analogsensorclient", "cartesiancontrollerclient", "clientcontrolboard"),
    *("gazecontrollerclient", "multipleanalogsensorsclient", "remote_controlboard"),
    "remote_grabber",
)

#: What a type needs beside yarpy itself.
_EXTRAS: Final = {
    "dynamixelServos": "hardware",
    "feetechServos": "hardware",
    "opencv_grabber": "vision",
    "portaudioPlayer": "audio",
    "portaudioRecorder": "audio",
    "realsense2": "realsense",
    "witmotionImu": "hardware",
    "xsensImu": "hardware",
}

#: Type -> where it is in the kit of devices.
_DEVICES: Final[dict[str, str]] = {
    "analogServer": "wrapper:Analog",
    "battery_nws_yarp": "wrapper:Battery",
    "controlBoard_nws_yarp": "wrapper:ControlBoard",
    "controlboardremapper": "control_board.remapper:Remapper",
    "controlboardwrapper2": "wrapper:ControlBoard",
    "dynamixelServos": "hardware.servo:dynamixel",
    "fakeAnalogSensor": "simulated.plugin:analog",
    "fakeDepthCamera": "simulated.plugin:depth_camera",
    "fakeFrameGrabber": "simulated.plugin:camera",
    "fakeFrameWriter": "simulated.plugin:frame_writer",
    "fakeIMU": "simulated.plugin:imu",
    "fakeLaser": "simulated.plugin:laser",
    "fakeMotionControl": "simulated.plugin:joints",
    "feetechServos": "hardware.servo:feetech",
    "frameGrabber_nws_yarp": "wrapper:FrameGrabber",
    "frameTransformClient": "remote:transforms",
    "frameTransformServer": "remote:transform_server",
    "frameWriter_nws_yarp": "wrapper:FrameWriter",
    "gamepad": "hardware.gamepad:gamepad",
    "map2DStorage": "simulated.plugin:map_storage",
    "multipleanalogsensorsremapper": "multi_sensor.remapper:Remapper",
    "multipleanalogsensorsserver": "wrapper:MultiSensor",
    "opencv_grabber": "hardware.opencv:camera",
    "portaudioPlayer": "hardware.portaudio:player",
    "portaudioRecorder": "hardware.portaudio:recorder",
    "rangefinder2D_nws_yarp": "wrapper:Laser",
    "rosControlBoard": "hardware.topics:ros_board",
    "realsense2": "hardware.realsense:realsense",
    "remotecontrolboardremapper": "control_board.remapper:remote_remapper",
    "test_grabber": "simulated.plugin:camera",
    "usbCamera": "hardware.v4l2:usb_camera",
    "virtualAnalogServer": "analog.plugin:VirtualAnalog",
    "witmotionImu": "hardware.imu:witmotion_imu",
    "xsensImu": "hardware.imu:xsens_imu",
    **dict.fromkeys(_SIMULATED, "simulated.plugin:simulated"),
    **dict.fromkeys(_SERVERS, "wrapper:Served"),
    **dict.fromkeys(_CLIENTS, "remote:remote"),
}
_SIM: Final = {
    "simulatedEye": "SimulatedEye",
    "simulatedHead": "simulated_head",
    "simulatedInertial": "SimulatedInertial",
}

DEVICES: Final[Mapping[str, Row]] = {
    **{
        name: Row(name, f"yarpy.kits.devices.{place}", _EXTRAS.get(name, ""))
        for name, place in _DEVICES.items()
    },
    **{name: Row(name, f"yarpy.kits.sim.device:{place}") for name, place in _SIM.items()},
}
