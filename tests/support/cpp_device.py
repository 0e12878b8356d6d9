"""C++ YARP's own robot devices as peers: controlBoard_nws_yarp, remote_controlboard and others.

    host = device_host(cpp)                      # MissingPeer says why there is none
    with cpp_device(programs, "controlBoard_nws_yarp", subdevice="remote_controlboard", ...) as p:
        ...

The package with the C++ programs brings its devices as static libraries and with headers, but has
linked none of them into its `yarpdev`. So one is linked here, from a few lines.
"""

import contextlib
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_link import linked
from support.process import Process

DEVICES = (
    "remote_controlboard",
    "controlBoard_nws_yarp",
    "frameGrabber_nws_yarp",
    "frameGrabber_nwc_yarp",
    "fakeFrameGrabber",
    "multipleanalogsensorsserver",
    "multipleanalogsensorsclient",
    "mobileBaseVelocityControl_nws_yarp",
    "mobileBaseVelocityControl_nwc_yarp",
    "localization2D_nws_yarp",
    "localization2D_nwc_yarp",
    "navigation2D_nws_yarp",
    "navigation2D_nwc_yarp",
    "map2D_nws_yarp",
    "map2D_nwc_yarp",
    "map2DStorage",
    "controlboardremapper",
    "remotecontrolboardremapper",
    "analogServer",
    "analogsensorclient",
    "batteryClient",
    "batteryWrapper",
    "Rangefinder2DClient",
    "rangefinder2D_nws_yarp",
    "RGBDSensorClient",
    "rgbdSensor_nws_yarp",
    "JoypadControlClient",
    "JoypadControlServer",
    "AudioRecorderWrapper",
    "AudioPlayerWrapper",
    "audioFromFileDevice",
    "audioToFileDevice",
    "virtualAnalogServer",
)
#: What 3.9 calls some of them.
_NEWER = {
    "batteryClient": "battery_nwc_yarp",
    "batteryWrapper": "battery_nws_yarp",
    "Rangefinder2DClient": "rangefinder2D_nwc_yarp",
    "AudioRecorderWrapper": "audioRecorder_nws_yarp",
}
#: What 4.0 calls some of them, and of their options.
_LATEST = {
    "filexml_option": "config_name",
    "JoypadControlClient": "JoypadControl_nwc_yarp",
    "JoypadControlServer": "JoypadControl_nws_yarp",
    "remote_controlboard": "controlBoard_nwc_yarp",
    "RGBDSensorClient": "RGBDSensor_nwc_yarp",
    "rgbdSensor_nws_yarp": "RGBDSensor_nws_yarp",
    "robotDescriptionClient": "robotDescription_nwc_yarp",
}
#: Servers that 3.9 opens without what they serve; a robot interface attaches it.
_ATTACHED = (
    *("audioRecorder_nws_yarp", "battery_nws_yarp", "localization2D_nws_yarp", "map2D_nws_yarp"),
    *("odometry2D_nws_yarp",),
    *("navigation2D_nws_yarp", "serialPort_nws_yarp", "speechSynthesizer_nws_yarp"),
    *("speechTranscription_nws_yarp", "chatBot_nws_yarp", "LLM_nws_yarp"),
    *("frameTransformGet_nws_yarp", "frameTransformSet_nws_yarp"),
)

#: A device of our own in C++: the one that `inner` names, given on once it has heard of its server.
#: (A client of descriptions gives the only camera a twin then, and removes the arm.)
PATIENT = "patient"

#: Another one: motors that print the torques which they are told.
MOTORS = "motors"

_SOURCE = """
#include <yarp/dev/DeviceDriver.h>
#include <yarp/dev/Drivers.h>
#include <yarp/dev/IAnalogSensor.h>
#include <yarp/dev/IJoypadController.h>
#include <yarp/dev/IMultipleWrapper.h>
#include <yarp/dev/IRobotDescription.h>
#include <yarp/dev/IVirtualAnalogSensor.h>
#include <yarp/dev/PolyDriver.h>
#include <yarp/dev/PolyDriverList.h>
#include <yarp/os/Network.h>
#include <yarp/os/Property.h>
#include <yarp/os/Time.h>
#include <yarp/sig/Vector.h>
#include <iostream>
class Motors : public yarp::dev::DeviceDriver, public yarp::dev::IVirtualAnalogSensor {
public:
    bool open(yarp::os::Searchable&) override { return true; }
    bool close() override { return true; }
    yarp::dev::VAS_status getVirtualAnalogSensorStatus(int) override {
        return yarp::dev::VAS_status::VAS_OK;
    }
    int getVirtualAnalogSensorChannels() override { return 6; }
    bool updateVirtualAnalogSensorMeasure(yarp::sig::Vector& torques) override {
        std::cout << "told";
        for (size_t at = 0; at < torques.size(); at++) std::cout << ' ' << torques[at];
        std::cout << std::endl;
        return true;
    }
    bool updateVirtualAnalogSensorMeasure(int, double&) override { return false; }
};
class Patient : public yarp::dev::DeviceDriver {
    yarp::dev::PolyDriver driver;
    bool hasHeard() {
        yarp::dev::IAnalogSensor* sensor = nullptr;
        if (driver.view(sensor)) return sensor->getChannels() > 0;
        yarp::dev::IRobotDescription* robot = nullptr;
        std::vector<yarp::dev::DeviceDescription> found;
        if (driver.view(robot)) {
            if (!robot->getAllDevicesByType("camera", found) || found.size() != 1) return false;
            found[0].device_name += "_twin";
            return robot->registerDevice(found[0]) && robot->getAllDevices(found)
                && found.size() == 3 && robot->unregisterDevice("arm");
        }
        yarp::dev::IJoypadController* pad = nullptr;
        double axis;
        return driver.view(pad) && pad->getAxis(0, axis);
    }
public:
    bool open(yarp::os::Searchable& config) override {
        yarp::os::Property options;
        options.fromString(config.toString());
        options.put("device", config.find("inner").asString());
        if (!driver.open(options)) return false;
        for (int wait = 0; wait < 2000 && !hasHeard(); wait++)
            yarp::os::Time::delay(0.01);
        return hasHeard();
    }
    bool close() override { return driver.close(); }
    yarp::dev::DeviceDriver* getImplementation() override { return driver.getImplementation(); }
};
class Attached : public yarp::dev::DeviceDriver {
    yarp::dev::PolyDriver inner, outer;
public:
    bool open(yarp::os::Searchable& config) override {
        yarp::os::Property options;
        options.fromString(config.toString());
        options.unput("wrapped");
        options.unput("wrapping_enabled");
        options.put("device", config.find("attach").asString());
        if (!inner.open(options)) return false;
        options.put("device", config.find("outer").asString());
        yarp::dev::IMultipleWrapper* wrapper = nullptr;
        yarp::dev::PolyDriverList list;
        list.push(&inner, "inner");
        return outer.open(options) && outer.view(wrapper) && wrapper->attachAll(list);
    }
    bool close() override { return outer.close() && inner.close(); }
};
int main(int argc, char* argv[]) {
    yarp::os::Network network;
    add_plugins();
    yarp::dev::Drivers::factory().add(
        new yarp::dev::DriverCreatorOf<Patient>("patient", "", "Patient"));
    yarp::dev::Drivers::factory().add(
        new yarp::dev::DriverCreatorOf<Motors>("motors", "", "Motors"));
    yarp::dev::Drivers::factory().add(
        new yarp::dev::DriverCreatorOf<Attached>("attached", "", "Attached"));
    return yarp::dev::Drivers::factory().yarpdev(argc, argv);
}
"""


def device_host(cpp: CppYarp) -> Path:
    """A yarpdev with `DEVICES`; links it the first time. Or MissingPeer."""
    return linked(
        cpp,
        "devices",
        _SOURCE,
        DEVICES,
        ["YARP_dev", "YARP_sig", "YARP_math", "YARP_os", "YARP_init"],
    )


@contextlib.contextmanager
def cpp_device(programs: CppYarp, device: str, **options: object) -> Iterator[Process]:
    """A C++ process with this device, opened with `--option value` for each of the options."""
    if programs.version >= (4, 0):
        device, options = _of_4(device, options)
    elif programs.version >= (3, 9):
        device = _NEWER.get(device, device)
        inner = str(options.get("subdevice", ""))
        options = {**options, "subdevice": _NEWER.get(inner, inner)} if inner else options
        if device in _ATTACHED:
            attach = options.pop("subdevice")
            device, options = "attached", {**options, "outer": device, "attach": attach}
    words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    command = [device_host(programs), "--device", device, *words]
    with Process(command, env=programs.environment, cwd=programs.home) as process:
        process.wait_line("device active in background|not available", timeout=30)
        missing = re.search(r"Could not find device <(\w+)>", process.stdout + process.stderr)
        if missing and programs.package is None:
            pytest.skip(f"{programs.root} has no device {missing[1]}: build it there")
        yield process


def _of_4(device: str, options: dict[str, object]) -> tuple[str, dict[str, object]]:
    """The device and its options as 4.0 has them, whose servers open nothing that they serve."""

    def renamed(name: str) -> str:
        name = _NEWER.get(name, name)
        return _LATEST.get(name, name)

    if device == "analogServer":
        pytest.skip("YARP 4 has no sensors with channels any more")
    if device == "robotDescriptionServer":
        place = f"{options['local']}/rpc"
        options = {"subdevice": "robotDescriptionStorage", "local": place}
        device = "robotDescription_nws_yarp"
    options = {renamed(key): value for key, value in options.items()}
    if "inner" in options:
        options["inner"] = renamed(str(options["inner"]))
    if "subdevice" not in options:
        return renamed(device), options
    inner = renamed(str(options.pop("subdevice")))
    return "attached", {**options, "outer": renamed(device), "attach": inner}


@contextlib.contextmanager
def between(programs: CppYarp, server: str, client: str, /, **options: object) -> Iterator[None]:
    """C++ in the middle: its client of /ours, served again as /cpp."""
    options = {"name": "/cpp", "local": "/between", "remote": "/ours", **options}
    with cpp_device(programs, server, subdevice=client, **options) as process:
        assert "not available" not in process.stdout, process.stdout + process.stderr
        yield
