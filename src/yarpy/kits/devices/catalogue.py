"""The types of devices that can be opened, each with its purpose in a line: `yarpy dev --list`.

    catalogue()[0]      ("battery_nwc_yarp", "client of a battery")

Rules: every type that ships with yarpy has a purpose here, which is told without importing it. Of a
type of another package it is the first line of its docstring.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from yarpy.errors import UnknownPlugin
from yarpy.facts import Row
from yarpy.registry import Registry
from yarpy.registry import devices as installed

#: What has servers and clients, by the part of their names before `_nws_yarp` and `_nwc_yarp`, and
#: what is simulated of it.
_KINDS: Final = {
    "LLM": ("a language model", "fakeLLMDevice"),
    "RGBDSensor": ("a camera with distances", "fakeDepthCamera"),
    "audioRecorder": ("a microphone", "fakeMicrophone"),
    "battery": ("a battery", "fakeBattery"),
    "chatBot": ("a chat bot", "fakeChatBotDevice"),
    "controlBoard": ("the joints of a robot", "fakeMotionControl"),
    "frameGrabber": ("a camera", "fakeFrameGrabber"),
    "JoypadControl": ("a joypad", "fakeJoypad"),
    "localization2D": ("the localization of a robot", "fakeLocalizer"),
    "map2D": ("a store of maps and places", ""),
    "mobileBaseVelocityControl": ("a base that drives", ""),
    "navigation2D": ("the navigation of a robot", "fakeNavigation"),
    "odometry2D": ("the odometry of a base", "fakeOdometry2D"),
    "rangefinder2D": ("a laser scanner", "fakeLaser"),
    "robotDescription": ("the list of a robot's devices", ""),
    "serialPort": ("a serial port", "fakeSerialPort"),
    "simulatedWorld": ("the world of a simulator", ""),
    "speechSynthesizer": ("a voice", "fakeSpeechSynthesizer"),
    "speechTranscription": ("speech recognition", "fakeSpeechTranscription"),
}
_SERVERS: Final = {
    "analogServer": "a sensor with channels, as older robots have it",
    "AudioPlayerWrapper": "a loudspeaker",
    "frameWriter_nws_yarp": "a screen: shows the pictures that come to its port",
    "controlboardwrapper2": "joints, as older YARP called it",
    "JoypadControlServer": "a joypad, as older YARP called it",
    "rgbdSensor_nws_yarp": "a camera with distances, as older YARP called it",
    "multipleanalogsensorsserver": "sensors, such as an inertial unit",
}
_CLIENTS: Final = {
    "analogsensorclient": "a sensor with channels, as older robots have it",
    "JoypadControlClient": "a joypad, as older YARP called it",
    "RGBDSensorClient": "a camera with distances, as older YARP called it",
    "RemoteFrameGrabber": "a camera, as older YARP called it",
    "cartesiancontrollerclient": "what moves a hand to a place (iCub)",
    "clientcontrolboard": "joints, as older YARP called it",
    "frameTransformClient": "the frames that a frameTransformServer knows",
    "gazecontrollerclient": "what turns head and eyes to a point (iCub)",
    "multipleanalogsensorsclient": "sensors, such as an inertial unit",
    "remote_controlboard": "joints",
    "remote_grabber": "a camera, as older YARP called it",
}
_OTHERS: Final = {
    "controlboardremapper": "the joints of the boards that are attached, as one board",
    "dynamixelServos": "servos of Dynamixel on a line: served by controlBoard_nws_yarp",
    "feetechServos": "servos of Feetech on a line: served by controlBoard_nws_yarp",
    "fakeAnalogSensor": "simulated sensor with channels: served by analogServer",
    "fakeFrameWriter": "a screen without hardware: served by frameWriter_nws_yarp",
    "fakeIMU": "simulated inertial unit: served by multipleanalogsensorsserver",
    "fakeJointCoupling": "simulated coupling of joints, for programs in the same process",
    "fakePositionSensor": "simulated position and orientation: "
    "served by multipleanalogsensorsserver",
    "fakeSimulatedWorld": "a world without a simulator: served by simulatedWorld_nws_yarp",
    "fakeSpeaker": "simulated loudspeaker: served by AudioPlayerWrapper",
    "frameTransformServer": "knows where frames are, and tells who asks; serves itself",
    "map2DStorage": "maps and places, of a folder if asked for: served by map2D_nws_yarp",
    "gamepad": "a gamepad or joystick of Linux: served by JoypadControl_nws_yarp",
    "multipleanalogsensorsremapper": "the sensors of what is attached, as one device",
    "opencv_grabber": "a camera or film of OpenCV: served by frameGrabber_nws_yarp",
    "portaudioPlayer": "the loudspeaker of this computer: served by AudioPlayerWrapper",
    "portaudioRecorder": "the microphone of this computer: served by audioRecorder_nws_yarp",
    "realsense2": "a RealSense camera: served by RGBDSensor_nws_yarp",
    "remotecontrolboardremapper": "the joints of boards of other programs, as one board",
    "robotDescriptionStorage": "a list of devices: served by robotDescription_nws_yarp",
    "rosControlBoard": "the joints of a robot of ROS: served by controlBoard_nws_yarp",
    "simulatedEye": "eye of the simulated iCub: attach simulatedHead",
    "simulatedHead": "joints of the simulated iCub's head: served by controlBoard_nws_yarp",
    "simulatedInertial": "inertial unit of the simulated iCub: attach simulatedHead",
    "witmotionImu": "inertial unit of WitMotion on a line: served by multipleanalogsensorsserver",
    "xsensImu": "MTi of Xsens on a line: served by multipleanalogsensorsserver",
    "usbCamera": "a camera of Linux, without OpenCV: served by frameGrabber_nws_yarp",
    "virtualAnalogServer": "torques that another program estimates, for what is attached",
    "test_grabber": "fakeFrameGrabber, as older YARP called it",
}


def _shipped() -> Iterator[tuple[str, str]]:
    for kind, (what, fake) in _KINDS.items():
        yield f"{kind}_nws_yarp", f"server of {what}"
        yield f"{kind}_nwc_yarp", f"client of {what}"
        if fake:
            bare = what.removeprefix("a ").removeprefix("the ")
            yield fake, f"simulated {bare}: served by {kind}_nws_yarp"
    yield from ((name, f"server of {what}") for name, what in _SERVERS.items())
    yield from ((name, f"client of {what}") for name, what in _CLIENTS.items())
    yield from _OTHERS.items()


#: Of the types that ship with yarpy.
PURPOSES: Final = dict(_shipped())


def catalogue(plugins: Registry[Row] | None = None) -> list[tuple[str, str]]:
    """Return the types that can be opened with their purposes, sorted by name."""
    plugins = installed if plugins is None else plugins
    names = sorted(plugins.names(), key=lambda name: (name.lower(), name))
    return [(name, PURPOSES.get(name) or _asked(plugins, name)) for name in names]


def lines() -> list[str]:
    """Return the catalogue as text, in two columns."""
    rows = catalogue()
    width = max(len(name) for name, _ in rows)
    return [f"  {name:{width}}  {purpose}".rstrip() for name, purpose in rows]


def _asked(plugins: Registry[Row], name: str) -> str:
    """Return the purpose of a type of another package."""
    owner = plugins.owner(name)
    try:
        text = str(getattr(plugins.load(name), "__doc__", None) or "").strip()
    except UnknownPlugin:
        return f"does not load: yarpy dev {name} says why"
    first = text.partition("\n")[0].strip().rstrip(".")
    return first or (f"of the package {owner}" if owner else "")
