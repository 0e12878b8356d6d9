"""The table of YARP's device interfaces in docs/devices.md, made from the code.

    python tests/support/device_table.py      writes it; tests/test_device_table.py compares

Rules: each interface of YARP 3.9.1 and 4.0.0 has a row. Which classes, views and tests there are is
looked up; `WHY` says why there are none.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from yarpy.kits.devices.interfaces import interfaces

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.device_times import tables

ROOT: Final = Path(__file__).parents[2]
PAGE: Final = ROOT / "docs" / "devices.md"
BEGIN: Final = "<!-- generated: interfaces -->\n"
TIMES: Final = "<!-- generated: times -->\n"
END: Final = "<!-- end -->\n"

#: The headers of YARP's library of devices, 3.9.1 and 4.0.0, and those within others.
_NAMES: Final = """
IAmplifierControl IAnalogSensor IAudioGrabberSound IAudioRender IAudioVisualGrabber
IAudioVisualStream IAxisInfo IBattery ICalibrator ICartesianControl IChatBot IControlCalibration
IControlDebug IControlLimits IControlMode ICurrentControl IDepthVisualParams IDeviceDriverParams
IEncoders IEncodersTimed IFrameGrabber IFrameGrabberControls IFrameGrabberControlsDC1394
IFrameGrabberImage IFrameGrabberRgb IFrameTransform IFrameTransformClientControl
IFrameTransformStorage IFrameWriterAudioVisual IFrameWriterImage IGazeControl IGenericSensor
IHapticDevice IImpedanceControl IInteractionMode IJacobianCoupling IJointBrake IJointCoupling
IJointFault IJoypadController ILLM ILocalization2D IMap2D IMotor IMotorEncoders IMultipleWrapper
INavigation2D INavigation2DVelocityActions IOdometry2D IPWMControl IPidControl IPositionControl
IPositionDirect IPreciselyTimed IRGBDSensor IRangefinder2D IRemoteCalibrator IRemoteVariables
IRgbVisualParams IRobotDescription ISerialDevice ISimulatedWorld ISpeechSynthesizer
ISpeechTranscription ITorqueControl IVelocityControl IVelocityDirect IVirtualAnalogSensor
IVisualParams IVisualServoing IWrapper IContactLoadCellArrays IEncoderArrays IOrientationSensors
IPositionSensors ISixAxisForceTorqueSensors ISkinPatches ITemperatureSensors
IThreeAxisGyroscopes IThreeAxisLinearAccelerometers IThreeAxisMagnetometers
ILinearVelocitySensors IThreeAxisAngularAccelerometers
"""
NAMES: Final = _NAMES.split()

#: Devices with code of their own: class here, server and client and simulated device of C++, and
#: the interfaces that they have.
OWN: Final = (
    (
        "ControlBoard",
        "controlBoard_nws_yarp",
        "controlBoard_nwc_yarp",
        "fakeMotionControl",
        "IAmplifierControl IAxisInfo IControlCalibration IControlLimits IControlMode "
        "ICurrentControl IEncoders IEncodersTimed IImpedanceControl IInteractionMode IJointFault "
        "IMotor IMotorEncoders IPWMControl IPidControl IPositionControl IPositionDirect "
        "IPreciselyTimed IRemoteCalibrator IRemoteVariables ITorqueControl IVelocityControl "
        "IJointBrake IVelocityDirect",
    ),
    (
        "FrameGrabber",
        "frameGrabber_nws_yarp",
        "frameGrabber_nwc_yarp",
        "fakeFrameGrabber",
        "IFrameGrabberControls IFrameGrabberControlsDC1394 IFrameGrabberImage IRgbVisualParams",
    ),
    (
        "MultiSensor",
        "multipleanalogsensorsserver",
        "multipleanalogsensorsclient",
        "",
        "IContactLoadCellArrays IEncoderArrays ISixAxisForceTorqueSensors "
        "ISkinPatches ITemperatureSensors ILinearVelocitySensors IThreeAxisAngularAccelerometers",
    ),
    (
        "MultiSensor",
        "multipleanalogsensorsserver",
        "multipleanalogsensorsclient",
        "fakeIMU",
        "IOrientationSensors IThreeAxisGyroscopes IThreeAxisLinearAccelerometers "
        "IThreeAxisMagnetometers",
    ),
    (
        "MultiSensor",
        "multipleanalogsensorsserver",
        "multipleanalogsensorsclient",
        "fakePositionSensor",
        "IPositionSensors",
    ),
    ("Battery", "battery_nws_yarp", "battery_nwc_yarp", "fakeBattery", "IBattery"),
    ("Laser", "rangefinder2D_nws_yarp", "rangefinder2D_nwc_yarp", "fakeLaser", "IRangefinder2D"),
    (
        "TransformClient",
        "frameTransformServer",
        "frameTransformClient",
        "",
        "IFrameTransform IFrameTransformStorage",
    ),
    (
        "CartesianController",
        "cartesiancontrollerserver",
        "cartesiancontrollerclient",
        "",
        "ICartesianControl",
    ),
    ("GazeController", "iKinGazeCtrl", "gazecontrollerclient", "", "IGazeControl"),
    ("AnalogSensor", "analogServer", "analogsensorclient", "fakeAnalogSensor", "IAnalogSensor"),
    ("FrameWriterServer", "frameWriter_nws_yarp", "", "fakeFrameWriter", "IFrameWriterImage"),
    (
        "VirtualAnalogServer",
        "virtualAnalogServer",
        "",
        "fakeMotionControl",
        "IVirtualAnalogSensor",
    ),
)

#: Tests that C++ 3.5 does not meet, and that 3.9.1 does not; all others meet both, and 4.0.0, where
#: YARPY_CPP_YARP names it.
NEWER: Final = {"test_newer_devices.py", "test_yarp4_devices.py"}
LATEST: Final = {"test_yarp4_devices.py"}

#: What the servers of C++ 3.5 and 3.9 are called there, and in the tests.
OLDER: Final = {
    "RGBDSensor_nws_yarp": "rgbdSensor_nws_yarp",
    "battery_nws_yarp": "batteryWrapper",
    "JoypadControl_nws_yarp": "JoypadControlServer",
    "robotDescription_nws_yarp": "robotDescriptionServer",
}

#: Interfaces that another one has in itself.
ALSO: Final = {"IRGBDSensor": "IDepthVisualParams"}

#: What no C++ here has, or was not asked for when it was recorded.
_SINCE: Final = ("ILinearVelocitySensors", "IThreeAxisAngularAccelerometers")
#: What only boards of 4.0 have.
_BOARD_4: Final = ("IJointBrake", "IVelocityDirect")
#: What was not tried with 4.0.0.
_NOT_4: Final = ("AnalogSensor",)

#: What icub-main has, not YARP, and the test of what its programs were recorded to say.
_ICUB: Final = ("ICartesianControl", "IGazeControl")
_RECORDED: Final = "tests/kits/devices/controllers/test_icub.py"

_ALONE: Final = "C++ has no server or client of it: it stays within a program"
_OLD: Final = "C++ has none of it any more"

#: Why there is no class.
WHY: Final = {
    "IAudioVisualGrabber": _ALONE,
    "IAudioVisualStream": _ALONE,
    "ICalibrator": _ALONE,
    "IControlDebug": _ALONE,
    "IDeviceDriverParams": "options of devices of C++: here they are arguments of classes",
    "IFrameGrabber": _OLD,
    "IFrameGrabberRgb": _OLD,
    "IFrameTransformClientControl": "starts what C++ connects later; here it is connected at once",
    "IFrameWriterAudioVisual": _ALONE,
    "IGenericSensor": _ALONE,
    "IHapticDevice": _ALONE,
    "IJacobianCoupling": _ALONE,
    "IJointCoupling": f"{_ALONE}; `fakeJointCoupling`",
    "IMultipleWrapper": "how devices are attached in C++: here they are arguments of servers",
    "IVisualParams": _OLD,
    "IVisualServoing": _ALONE,
    "IWrapper": "how devices are attached in C++: here they are arguments of servers",
}


def table() -> str:
    """The rows, with their head."""
    views = "".join(path.read_text() for path in (ROOT / "compat/src/yarp").glob("_*.py"))
    tests = {path.name: path.read_text() for path in (ROOT / "tests/interop").glob("test_*.py")}
    rows: dict[str, tuple[str, str, str, str]] = {}
    for name, server, client, fake, has in OWN:
        for each in has.split():
            rows[each] = (name, server, client, fake)
    for name, interface in interfaces().items():
        view = interface.VIEW or "INavigation2DVelocityActions"
        for each in (view, *ALSO.get(view, "").split()):
            rows.setdefault(each, (name, interface.NWS, interface.NWC, interface.FAKE))
    lines = [
        "| interface | here | server (nws), client (nwc), simulated | view | tried with | by |",
        "|---|---|---|---|---|---|",
    ]
    for each in sorted(NAMES):
        if each not in rows:
            lines.append(f"| `{each}` | {WHY[each]} | | | | |")
            continue
        name, *devices = rows[each]
        there = ", ".join(f"`{device}`" for device in devices if device)
        view = "✔" if f"def view{each}(" in views else ""
        peer = f'"{OLDER.get(devices[0], devices[0])}"'
        among = {file for file, text in tests.items() if peer in text}
        rest = {"3.5": NEWER, "3.9.1": LATEST, **({} if name in _NOT_4 else {"4.0.0": set()})}
        tried = [version for version, others in rest.items() if among - others]
        tried = ["4.0.0"] if each in _BOARD_4 else tried
        tried[:1] = [f"C++ {version}" for version in tried[:1]]
        tried = [] if each in _SINCE else tried
        among = among & LATEST if each in _BOARD_4 else among
        by = ", ".join(f"[{file[5:-3]}](../tests/interop/{file})" for file in sorted(among))
        if each in _ICUB:
            assert (ROOT / _RECORDED).exists()
            tried, by = ["icub-main 2.6"], f"[icub](../{_RECORDED})"
        by = by if tried else ""
        tested = f"{', '.join(tried)} | {by}"
        lines.append(f"| `{each}` | `{name}` ✔ | {there} | {view} | {tested} |")
    return "\n".join(lines) + "\n"


def page() -> str:
    """The whole page with the table of today."""
    text = PAGE.read_text(encoding="utf-8")
    for begin, made in ((BEGIN, table()), (TIMES, tables())):
        before, _, rest = text.partition(begin)
        _, _, after = rest.partition(END)
        text = f"{before}{begin}{made}{END}{after}"
    return text


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
