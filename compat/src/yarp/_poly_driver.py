"""PolyDriver: opens a device by its name, and shows it through interfaces.

Rules: the clients and servers are those of `yarpy.devices`; `DEVICES` lists their names. Types of
devices that packages bring (entry point `yarpy.devices`) are opened, too. A Python object with the
members that `devices.control_board.interface` describes is a device as well: `attach` serves it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import yarpy
from yarp import _names, _network_device
from yarp._camera_view import IFrameGrabberControls, IFrameGrabberImage, IFrameGrabberRgb
from yarp._control_view import IControlLimits, IControlMode, IInteractionMode
from yarp._device import DeviceDriver
from yarp._log import say
from yarp._measuring_view import (
    IAmplifierControl,
    IAxisInfo,
    IEncoders,
    IEncodersTimed,
    IJointFault,
    IMotor,
    IMotorEncoders,
    IRemoteVariables,
)
from yarp._mirror_views import MirrorViews
from yarp._motion_view import (
    ICurrentControl,
    IImpedanceControl,
    IPositionControl,
    IPositionDirect,
    IPWMControl,
    ITorqueControl,
    IVelocityControl,
)
from yarp._pid_view import IPidControl
from yarp._property import Property
from yarp._searchable import Searchable
from yarp._table import NOT_HERE
from yarp._value import Value
from yarp._view import FAILURES
from yarpy.kits import devices
from yarpy.registry import devices as installed

V = TypeVar("V")


class PolyDriver(MirrorViews):
    """`PolyDriver(options)` or `open(options)`, `device` being one of them; then `viewI...`."""

    def __init__(self, config: Searchable | str | None = None) -> None:
        self._device: Any = None
        self._id = ""
        self._options = Property()
        self._waiting: dict[str, Any] | None = None  # a server that has nothing to serve yet
        if config is not None:
            self.open(config)

    def id(self) -> str:
        """Return its name: the option `id`, else the device, or what was given."""
        return self._id

    def setId(self, id: str) -> None:
        """Give it a name."""
        self._id = id

    def open(self, config: Searchable | str) -> bool:
        """Open the device that the options name; False if that fails."""
        self.close()
        if not isinstance(config, (str, Searchable, Value)):
            raise TypeError(f"a device is opened by its options, a Property, not {config!r:.40}")
        if isinstance(config, str):
            self._options = Property(config if config.startswith("(") else f"(device {config})")
        else:
            self._options = Property(config.toString())
        name = self._options.find("device").asString()
        self._id = self._options.check("id", Value(name)).toString()
        if name in ALIASES:
            name = ALIASES[name]
            self._options.put("device", name)
        make = PolyDriver._open_added if name in ADDED else DEVICES.get(name)
        if make is None and name in installed.names():
            make = PolyDriver._open_installed
        if make is None:
            say("ERROR", f"|yarp.dev.PolyDriver| Could not find device <{name}>: {_known()}")
            return False
        try:
            make(self)
        except (*FAILURES, ValueError, ImportError, OSError) as error:
            say("ERROR", f"|yarp.dev.PolyDriver| Could not open device <{name}>: {error}")
            self.close()
            return False
        return True

    open_str = open

    def close(self) -> bool:
        """Close the device."""
        device, self._device, self._waiting = self._device, None, None
        if device is not None and hasattr(device, "close"):
            device.close()
        return True

    def isValid(self) -> bool:
        """Return whether a device is open."""
        return self._device is not None or self._waiting is not None

    def attach(self, device: Any) -> bool:
        """Let a server that was opened serve a device: a PolyDriver, or an object of Python."""
        if self._waiting is None:
            say("ERROR", "|yarp.dev.PolyDriver| nothing can be attached to this device")
            return False
        inner = device._device if isinstance(device, PolyDriver) else device
        try:
            name = self._text("device")
            if name in _network_device.SERVED:
                self._device = _network_device.serve(name, inner, **self._waiting)
            else:
                if name == "frameWriter_nws_yarp":  # pictures come to it
                    del self._waiting["period"]
                self._device = getattr(devices, SERVERS[name])(device=inner, **self._waiting)
        except (*FAILURES, ValueError) as error:
            say("ERROR", f"|yarp.dev.PolyDriver| {error}")
            return False
        self._waiting = None
        return True

    def link(self, alt: PolyDriver) -> bool:
        """Be the same device as another."""
        self._device, self._options = alt._device, alt._options
        return self.isValid()

    def give(self, dd: Any, own: bool = True) -> bool:
        """Be this device, an object of Python."""
        self._device = dd.getImplementation() if isinstance(dd, DeviceDriver) else dd
        return dd is not None

    def take(self) -> Any:
        """Give the device up, and return it."""
        device, self._device = self._device, None
        return device

    def getImplementation(self) -> Any:
        """The device itself, of `yarpy.devices` or yours."""
        return self._device

    def getOptions(self) -> Any:
        """Return what it was opened with."""
        from yarp._bottle import Bottle

        return Bottle(self._options.toString())

    def getValue(self, option: str) -> Value:
        return self._options.find(option)

    def getDefaultValue(self, option: str) -> Value:
        return Value.getNullValue()

    def getComment(self, option: str) -> str:
        return ""

    def _view(self, kind: Callable[[Any], V], member: str) -> V | None:
        """A view, if the device has a member of that interface."""
        device = self._device
        found = device is not None and (hasattr(type(device), member) or hasattr(device, member))
        return kind(device) if found else None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("view"):
            known = ", ".join(sorted(one for one in dir(type(self)) if one.startswith("view")))
            why = NOT_HERE.get(name.removeprefix("view"), "the bindings of C++ YARP may have it")
            raise AttributeError(
                f"no device of yarpy-compat has the interface of {name} ({why}); there are "
                f"{known}. Open an issue of yarpy if you need it"
            )
        raise AttributeError(f"PolyDriver has no attribute {name!r}")

    # What an interface of a device is told by.

    def viewIPositionControl(self) -> IPositionControl | None:
        return self._view(IPositionControl, "position_move")

    def viewIPositionDirect(self) -> IPositionDirect | None:
        return self._view(IPositionDirect, "position_direct")

    def viewIVelocityControl(self) -> IVelocityControl | None:
        return self._view(IVelocityControl, "velocity_move")

    def viewITorqueControl(self) -> ITorqueControl | None:
        return self._view(ITorqueControl, "torques")

    def viewICurrentControl(self) -> ICurrentControl | None:
        return self._view(ICurrentControl, "currents")

    def viewIPWMControl(self) -> IPWMControl | None:
        return self._view(IPWMControl, "duty_cycles")

    def viewIImpedanceControl(self) -> IImpedanceControl | None:
        return self._view(IImpedanceControl, "impedances")

    def viewIEncoders(self) -> IEncoders | None:
        return self._view(IEncoders, "encoders")

    def viewIEncodersTimed(self) -> IEncodersTimed | None:
        return self._view(IEncodersTimed, "encoders")

    def viewIMotorEncoders(self) -> IMotorEncoders | None:
        return self._view(IMotorEncoders, "motor_encoders")

    def viewIMotor(self) -> IMotor | None:
        return self._view(IMotor, "motor_temperatures")

    def viewIAmplifierControl(self) -> IAmplifierControl | None:
        return self._view(IAmplifierControl, "amplifier_status")

    def viewIAxisInfo(self) -> IAxisInfo | None:
        return self._view(IAxisInfo, "axis_names")

    def viewIJointFault(self) -> IJointFault | None:
        return self._view(IJointFault, "faults")

    def viewIRemoteVariables(self) -> IRemoteVariables | None:
        return self._view(IRemoteVariables, "variables")

    def viewIControlMode(self) -> IControlMode | None:
        return self._view(IControlMode, "control_modes")

    viewIControlMode2 = viewIControlMode

    def viewIInteractionMode(self) -> IInteractionMode | None:
        return self._view(IInteractionMode, "interaction_modes")

    def viewIControlLimits(self) -> IControlLimits | None:
        return self._view(IControlLimits, "position_limits")

    def viewIPidControl(self) -> IPidControl | None:
        return self._view(IPidControl, "pids")

    def viewIFrameGrabberImage(self) -> IFrameGrabberImage | None:
        return self._view(IFrameGrabberImage, "image")

    def viewIFrameGrabber(self) -> IFrameGrabberRgb | None:
        return self._view(IFrameGrabberRgb, "image")

    def viewIFrameGrabberControls(self) -> IFrameGrabberControls | None:
        return self._view(IFrameGrabberControls, "features")

    viewIFrameGrabberControls2 = viewIFrameGrabberControls

    # -- devices ------------------------------------------------------------------------------

    def _text(self, key: str, default: str = "") -> str:
        return self._options.find(key).asString() or default

    def _remote(self) -> str:
        if not self._text("remote"):
            raise yarpy.AddressError('the option "remote" says whose it is: (remote /icub/head)')
        return self._text("remote")

    def _open_board(self) -> None:
        self._device = devices.ControlBoard(
            self._remote(),
            self._text("local"),
            carrier=self._text("carrier", "tcp"),
            names=_names.names(),
        )

    def _open_camera(self) -> None:
        self._device = devices.FrameGrabber(
            self._remote(),
            self._text("local"),
            carrier=self._text("carrier", "tcp"),
            names=_names.names(),
        )

    def _open_sensors(self) -> None:
        self._device = devices.MultiSensor(
            self._remote(),
            self._text("local"),
            carrier=self._text("carrier", "tcp"),
            timeout=self._options.find("timeout").asFloat64() or 0.5,
            names=_names.names(),
        )

    def _open_server(self) -> None:
        period = self._options.find("period").asFloat64()
        camera = SERVERS.get(self._text("device")) == "FrameGrabberServer"
        default = "/grabber" if camera else ""
        self._waiting = {
            "name": self._text("name") or self._text("local", default),
            # In files of robots it is in milliseconds.
            "period": (period / 1000 if period >= 1 else period) or 0.03,
            "names": _names.names(),
        }
        if not self._waiting["name"]:
            raise yarpy.AddressError('the option "name" says what its ports are called')

    def _open_client(self) -> None:
        name = self._text("device")
        self._device = _network_device.connect(name, self._text, _names.names())

    def _open_frames(self) -> None:
        self._device = devices.TransformServer(names=_names.names())

    def _open_local(self) -> None:
        self._device = _network_device.LOCAL[self._text("device")]()

    def _open_installed(self) -> None:
        name = self._text("device")
        options = yarpy.Property.from_text(self._options.toString())
        device = installed.load(name)(options, names=_names.names())
        if hasattr(device, "attach"):
            raise ValueError(f"it uses other devices: yarpdev --device {name} --subdevice TYPE")
        self._device = getattr(device, "served", device)

    def _open_added(self) -> None:
        device = ADDED[self._text("device")].create()
        if hasattr(device, "open") and device.open(self._options) is False:
            raise ValueError("it does not open with these options")
        self.give(device)

    def _open_fake_camera(self) -> None:
        width, height = (self._options.find(key).asInt32() for key in ("width", "height"))
        self._device = devices.SimulatedCamera(width or 320, height or 240)

    def _open_fake_motors(self) -> None:
        joints = self._options.findGroup("GENERAL").find("Joints").asInt32()
        self._device = devices.SimulatedJoints([f"joint{joint}" for joint in range(joints or 4)])

    def _open_remapper(self) -> None:
        boards, axes = (
            self._options.find(key).asList() for key in ("remoteControlBoards", "axesNames")
        )
        if boards is None or axes is None:
            raise yarpy.AddressError(
                "the lists remoteControlBoards and axesNames say whose joints it has: "
                "(remoteControlBoards (/icub/torso /icub/head)) (axesNames (torso_yaw neck_pitch))"
            )
        options = self._options.findGroup("REMOTE_CONTROLBOARD_OPTIONS")
        self._device = devices.remap_remote(
            [boards.get(at).asString() for at in range(boards.size())],
            [axes.get(at).asString() for at in range(axes.size())],
            self._text("localPortPrefix"),
            carrier=options.find("carrier").asString() or "tcp",
            names=_names.names(),
        )


#: Which class of `yarpy.devices` serves what is attached.
SERVERS = {
    "controlBoard_nws_yarp": "ControlBoardServer",
    "controlboardwrapper2": "ControlBoardServer",
    "frameGrabber_nws_yarp": "FrameGrabberServer",
    "multipleanalogsensorsserver": "MultiSensorServer",
    "battery_nws_yarp": "BatteryServer",
    "rangefinder2D_nws_yarp": "LaserServer",
    "analogServer": "AnalogSensorServer",
    "frameWriter_nws_yarp": "FrameWriterServer",
}
#: Devices that somebody has to serve, and who does unless the options say.
WRAPPERS = {
    "fakeAnalogSensor": "analogServer",
    "fakeBattery": "battery_nws_yarp",
    "fakeFrameWriter": "frameWriter_nws_yarp",
    "fakeLaser": "rangefinder2D_nws_yarp",
    "fakeIMU": "multipleanalogsensorsserver",
    "fakePositionSensor": "multipleanalogsensorsserver",
    "fakeFrameGrabber": "frameGrabber_nws_yarp",
    "test_grabber": "frameGrabber_nws_yarp",
    "fakeMotionControl": "controlBoard_nws_yarp",
}
#: Other names of devices, see `Drivers.addDeprecatedAlias`.
ALIASES: dict[str, str] = {}
#: What makes devices of other types, see `Drivers.add`.
ADDED: dict[str, Any] = {}
DEVICES = {
    "fakeFrameGrabber": PolyDriver._open_fake_camera,
    "test_grabber": PolyDriver._open_fake_camera,
    "fakeMotionControl": PolyDriver._open_fake_motors,
    "fakeAnalogSensor": PolyDriver._open_installed,
    "fakeFrameWriter": PolyDriver._open_installed,
    "fakeIMU": PolyDriver._open_installed,
    "fakeLaser": PolyDriver._open_installed,
    "remote_controlboard": PolyDriver._open_board,
    "controlBoard_nwc_yarp": PolyDriver._open_board,
    "remotecontrolboardremapper": PolyDriver._open_remapper,
    "clientcontrolboard": PolyDriver._open_board,
    "frameGrabber_nwc_yarp": PolyDriver._open_camera,
    "remote_grabber": PolyDriver._open_camera,
    "RemoteFrameGrabber": PolyDriver._open_camera,
    "multipleanalogsensorsclient": PolyDriver._open_sensors,
    **dict.fromkeys(SERVERS, PolyDriver._open_server),
    **dict.fromkeys(_network_device.CLIENTS, PolyDriver._open_client),
    **dict.fromkeys(_network_device.OWN, PolyDriver._open_client),
    "frameTransformClient": PolyDriver._open_client,
    "frameTransformServer": PolyDriver._open_frames,
    **dict.fromkeys(_network_device.SERVED, PolyDriver._open_server),
    **dict.fromkeys(_network_device.LOCAL, PolyDriver._open_local),
}


def _known() -> str:
    return f"yarpy-compat has {', '.join(sorted(DEVICES))}"
