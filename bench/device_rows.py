"""What `device_peers.py` asks of which device: one row an interface, both halves on both sides.

Rules: a row serves the same simulated device in C++ and here, under the same name and with the same
period. What it asks is answered by the server each time, never by the client alone.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import dataclass
from typing import Any

from yarpy.kits import devices

Version = tuple[int, int]
BOTH: tuple[Version, ...] = ((3, 9), (4, 0))
NEW: tuple[Version, ...] = ((4, 0),)
OLD: tuple[Version, ...] = ((3, 9),)
PERIOD = 0.01
MS = {"period": 10}
S = {"period": PERIOD}


@dataclass(frozen=True)
class Row:
    """One interface; `name` is what bench/device_client.cpp calls it."""

    name: str
    interface: str
    function: str
    """What is asked; empty where nothing is."""
    streams: str
    """The interface whose values stream in; empty for none."""
    ours: Callable[[], AbstractContextManager[Any]]
    server: tuple[str, dict[str, object]]
    """The server of C++, as tests/support/cpp_device.py names it, and its options: a pair of values
    is for 3.9 and for 4.0."""
    client: Callable[[Version], dict[str, object]]
    """Options of the client in C++, its device among them."""
    connect: Callable[[], Any]
    ask: Callable[[Any], object] | None = None
    seen: Callable[[Any], float] | None = None
    """When the newest value was made, seconds."""
    versions: tuple[Version, ...] = BOTH
    beside: Callable[[], AbstractContextManager[Any]] = nullcontext
    """What has to be there besides, whoever serves."""


def nwc(old: str, new: str = "", **options: object) -> Callable[[Version], dict[str, object]]:
    """Options of a client that 3.9 and 4.0 perhaps call differently."""
    given = {"local": "/asks", "remote": "/there", **options}

    def of(version: Version) -> dict[str, object]:
        return {"device": new if new and version >= (4, 0) else old, **given}

    return of


def robot(version: Version) -> dict[str, object]:
    """Those of the client of descriptions, whose old one adds the name of the port itself."""
    remote = "/there" if version < (4, 0) else "/there/rpc"
    device = "robotDescriptionClient" if version < (4, 0) else "robotDescription_nwc_yarp"
    return {"device": device, "local": "/asks", "remote": remote}


def frames(version: Version) -> dict[str, object]:
    """Those of the client of transforms, which are in a file that C++ brings."""
    option = "filexml_option" if version < (4, 0) else "config_name"
    return {"device": "frameTransformClient", option: "ftc_yarp_only.xml"}


def surroundings() -> ExitStack:
    """Where a base is and the maps, which its client asks for, too."""
    stack = ExitStack()
    stack.enter_context(devices.Localization2D.serve("/where", devices.SimulatedBase("kitchen")))
    stack.enter_context(devices.Map2D.serve("/maps", devices.MapStorage()))
    return stack


def newest(stream: str) -> Callable[[Any], float]:
    """When what an interface hears was made: what is heard itself does not say."""
    return lambda client: (getattr(client, stream)(), client._latest[stream].time())[1]


def picture(eye: Any) -> float:
    """When the next picture was taken."""
    eye.image()
    return float(eye.timestamp())


THERE = {"name": "/there"}
BASE = "/localization2D_nws_yarp"  # where C++ puts them unless a group of options says otherwise
WAY, MAPS = "/navigation2D_nws_yarp", "/map2D_nws_yarp"
LINE = "/serialPort_nws_yarp"
DEPTH = {
    "localImagePort": "/asks/colour",
    "localDepthPort": "/asks/depth",
    "localRpcPort": "/asks/rpc",
    "remoteImagePort": "/there/rgbImage:o",
    "remoteDepthPort": "/there/depthImage:o",
    "remoteRpcPort": "/there/rpc:i",
    "ImageCarrier": "fast_tcp",
    "DepthCarrier": "fast_tcp",
}

ROWS = [
    Row(
        "board",
        "IControlLimits",
        "getPosLimits",
        "IEncodersTimed",
        lambda: devices.ControlBoardServer("/there", devices.SimulatedJoints(["j0"]), PERIOD),
        (
            "controlBoard_nws_yarp",
            {"subdevice": "fakeMotionControl", "GENERAL::Joints": 1, **THERE, **S},
        ),
        nwc("remote_controlboard", "controlBoard_nwc_yarp", carrier="fast_tcp"),
        lambda: devices.ControlBoard("/there"),
        lambda board: board.position_limits,
        lambda board: board.timestamps()[0],
    ),
    Row(
        "camera",
        "IRgbVisualParams",
        "getRgbResolution",
        "IFrameGrabberImage",
        lambda: devices.FrameGrabberServer("/there", devices.SimulatedCamera(320, 240), PERIOD),
        (
            "frameGrabber_nws_yarp",
            {"subdevice": "fakeFrameGrabber", "width": 320, "height": 240, **THERE, **S},
        ),
        nwc("frameGrabber_nwc_yarp"),
        lambda: devices.FrameGrabber("/there"),
        lambda eye: eye.resolution,
        picture,
    ),
    Row(
        "depth",
        "IDepthVisualParams",
        "getDepthClipPlanes",
        "IRGBDSensor",
        lambda: devices.DepthCamera.serve("/there", devices.SimulatedDepthCamera(), PERIOD),
        ("rgbdSensor_nws_yarp", {"subdevice": "fakeDepthCamera", **THERE, **S}),
        nwc("RGBDSensorClient", "RGBDSensor_nwc_yarp", **DEPTH),
        lambda: devices.DepthCamera.connect("/there"),
        lambda eye: eye.clip_planes(),
        newest("colour"),
    ),
    Row(
        "sensors",
        "IThreeAxisGyroscopes",
        "",
        "IThreeAxisGyroscopes",
        lambda: devices.MultiSensorServer("/there", devices.SimulatedImu(), PERIOD),
        ("multipleanalogsensorsserver", {"subdevice": "fakeIMU", **THERE, **MS}),
        nwc("multipleanalogsensorsclient"),
        lambda: devices.MultiSensor("/there"),
        None,
        lambda imu: next(iter(imu.timestamps().values())),
    ),
    Row(
        "battery",
        "IBattery",
        "getBatteryInfo",
        "",
        lambda: devices.BatteryServer("/there", devices.SimulatedBattery(), PERIOD),
        ("batteryWrapper", {"subdevice": "fakeBattery", **THERE, **S}),
        nwc("battery_nwc_yarp"),
        lambda: devices.Battery("/there"),
        lambda battery: battery.info,
    ),
    Row(
        "laser",
        "IRangefinder2D",
        "getDistanceRange",
        "IRangefinder2D",
        lambda: devices.LaserServer("/there", devices.SimulatedLaser("use_constant"), PERIOD),
        (
            "rangefinder2D_nws_yarp",
            {"subdevice": "fakeLaser", "test": "use_constant", "const_distance": 0.5, **THERE, **S},
        ),
        nwc("rangefinder2D_nwc_yarp"),
        lambda: devices.Laser("/there"),
        lambda laser: laser.distances,
        lambda laser: laser.scan().time,
    ),
    Row(
        "odometry",
        "IOdometry2D",
        "resetOdometry",
        "IOdometry2D",
        lambda: devices.Odometry2D.serve("/there", devices.SimulatedBase("kitchen"), PERIOD),
        ("odometry2D_nws_yarp", {"subdevice": "fakeOdometry2D", **THERE, **S}),
        nwc("odometry2D_nwc_yarp"),
        lambda: devices.Odometry2D.connect("/there"),
        lambda base: base.reset_odometry(),
        newest("odometry"),
        NEW,
    ),
    Row(
        "channels",
        "IAnalogSensor",
        "calibrateChannel",
        "",
        lambda: devices.AnalogSensorServer("/there", devices.SimulatedAnalogSensor(), PERIOD),
        ("analogServer", {"subdevice": "fakeAnalogSensor", **THERE, **MS}),
        nwc("analogsensorclient", carrier="tcp"),
        lambda: devices.AnalogSensor("/there"),
        lambda sensor: sensor.calibrate_channel(0),
        versions=OLD,
    ),
    Row(
        "joypad",
        "IJoypadController",
        "getButtonCount",
        "",
        lambda: devices.Joypad.serve("/there", devices.SimulatedJoypad(), PERIOD),
        (
            "JoypadControlServer",
            {"subdevice": "fakeJoypad", "use_separate_ports": 1, **THERE, **MS},
        ),
        nwc("JoypadControl_nwc_yarp", period=PERIOD, use_all_port="false"),
        lambda: devices.Joypad.connect("/there"),
        lambda pad: pad.button_count(),
        versions=NEW,  # the client of 3.9 asks once
    ),
    Row(
        "frames",
        "IFrameTransform",
        "setTransform",
        "",
        lambda: devices.TransformServer(),
        ("frameTransformServer", {"filexml_option": "fts_yarp_only.xml"}),
        frames,
        lambda: devices.TransformClient(),
        lambda client: client.place("head", "base"),
    ),
    Row(
        "localization",
        "ILocalization2D",
        "getLocalizationStatus",
        "",
        lambda: devices.Localization2D.serve(BASE, devices.SimulatedBase("kitchen")),
        ("localization2D_nws_yarp", {"subdevice": "fakeLocalizer"}),
        nwc("localization2D_nwc_yarp", remote=BASE),
        lambda: devices.Localization2D.connect(BASE),
        lambda base: base.localization_status(),
    ),
    Row(
        "base",
        "INavigation2DVelocityActions",
        "getLastVelocityCommand",
        "",
        lambda: devices.MobileBase.serve("/there", devices.SimulatedBase("kitchen")),
        (
            "mobileBaseVelocityControl_nws_yarp",
            {"subdevice": "fakeNavigation", "local": "/there"},
        ),
        nwc("mobileBaseVelocityControl_nwc_yarp", server="/there"),
        lambda: devices.MobileBase.connect("/there"),
        lambda base: base.last_velocity(),
    ),
    Row(
        "maps",
        "IMap2D",
        "get_map_names",
        "",
        lambda: devices.Map2D.serve(MAPS, devices.MapStorage()),
        ("map2D_nws_yarp", {"subdevice": "map2DStorage"}),
        nwc("map2D_nwc_yarp", remote=MAPS),
        lambda: devices.Map2D.connect(MAPS),
        lambda storage: storage.map_names(),
    ),
    Row(
        "robot",
        "IRobotDescription",
        "getAllDevices",
        "",
        lambda: devices.Descriptions.serve("/there/rpc", devices.DescriptionStorage()),
        ("robotDescriptionServer", {"local": "/there"}),
        robot,
        lambda: devices.Descriptions.connect("/there/rpc"),
        lambda storage: storage.devices(),
    ),
    Row(
        "microphone",
        "IAudioGrabberSound",
        "isRecording",
        "",
        lambda: devices.AudioRecorder.serve("/there", devices.SimulatedMicrophone()),
        (
            "audioRecorder_nws_yarp",
            {
                "subdevice": "fakeMicrophone",
                "min_samples_over_network": 100,
                "max_samples_over_network": 2000,
                **THERE,
            },
        ),
        nwc("audioRecorder_nwc_yarp"),
        lambda: devices.AudioRecorder.connect("/there"),
        lambda microphone: microphone.recording(),
    ),
    Row(
        "serial",
        "ISerialDevice",
        "setDTR",
        "",
        lambda: devices.SerialPort.serve(LINE, devices.SimulatedSerialPort()),
        (
            "serialPort_nws_yarp",
            {"subdevice": "fakeSerialPort", "comport": "COM3", "baudrate": 9600, "name": LINE},
        ),
        nwc("serialPort_nwc_yarp", remote=f"{LINE}/rpc"),
        lambda: devices.SerialPort.connect(LINE),
        lambda line: line.enable_ready_line(True),
    ),
    Row(
        "voice",
        "ISpeechSynthesizer",
        "getLanguage",
        "",
        lambda: devices.SpeechSynthesizer.serve("/there", devices.SimulatedSynthesizer()),
        ("speechSynthesizer_nws_yarp", {"subdevice": "fakeSpeechSynthesizer", **THERE}),
        nwc("speechSynthesizer_nwc_yarp"),
        lambda: devices.SpeechSynthesizer.connect("/there"),
        lambda voice: voice.language(),
    ),
    Row(
        "ear",
        "ISpeechTranscription",
        "getLanguage",
        "",
        lambda: devices.SpeechTranscription.serve("/there", devices.SimulatedTranscription()),
        ("speechTranscription_nws_yarp", {"subdevice": "fakeSpeechTranscription", **THERE}),
        nwc("speechTranscription_nwc_yarp"),
        lambda: devices.SpeechTranscription.connect("/there"),
        lambda ear: ear.language(),
    ),
    Row(
        "chat",
        "IChatBot",
        "getLanguage",
        "",
        lambda: devices.ChatBot.serve("/there", devices.SimulatedChatBot()),
        ("chatBot_nws_yarp", {"subdevice": "fakeChatBotDevice", **THERE}),
        nwc("chatBot_nwc_yarp", remote="/there/rpc"),
        lambda: devices.ChatBot.connect("/there"),
        lambda bot: bot.language(),
    ),
    Row(
        "model",
        "ILLM",
        "getConversation",
        "",
        lambda: devices.LanguageModel.serve("/there", devices.SimulatedLanguageModel()),
        ("LLM_nws_yarp", {"subdevice": "fakeLLMDevice", "name": ("/there/rpc:i", "/there")}),
        nwc("LLM_nwc_yarp", remote="/there/rpc:i", streaming_name="/asks/stream"),
        lambda: devices.LanguageModel.connect("/there"),
        lambda model: model.conversation(),
    ),
    Row(
        "world",
        "ISimulatedWorld",
        "getList",
        "",
        lambda: devices.World.serve("/there", devices.SimulatedWorld()),
        ("simulatedWorld_nws_yarp", {"subdevice": "fakeSimulatedWorld", **THERE}),
        nwc("simulatedWorld_nwc_yarp"),
        lambda: devices.World.connect("/there"),
        lambda world: world.objects(),
        versions=NEW,
    ),
    Row(
        "navigation",
        "INavigation2D",
        "getNavigationStatus",
        "",
        lambda: devices.Navigation2D.serve(WAY, devices.SimulatedBase("kitchen")),
        ("navigation2D_nws_yarp", {"subdevice": "fakeNavigation"}),
        nwc(
            "navigation2D_nwc_yarp",
            navigation_server=WAY,
            map_locations_server="/maps",
            localization_server="/where",
        ),
        lambda: devices.Navigation2D.connect(WAY),
        lambda base: base.status(),
        beside=surroundings,
    ),
]
