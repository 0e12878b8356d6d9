"""C++ YARP's own robot devices as peers: controlBoard_nws_yarp, remote_controlboard and others.

    host = device_host(cpp)                      # MissingPeer says why there is none
    with cpp_device(programs, "controlBoard_nws_yarp", subdevice="remote_controlboard", ...) as p:
        ...

The package with the C++ programs brings its devices as static libraries and with headers, but has
linked none of them into its `yarpdev`. So one is linked here, from a few lines.
"""

import contextlib
from collections.abc import Iterator
from pathlib import Path

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
)
#: in the library of another
_WITHIN = {"remotecontrolboardremapper": "controlboardremapper"}
_LIBRARIES = [f"yarp_{name}" for name in DEVICES if name not in _WITHIN] + [
    f"YARP_{name}"
    for name in ("dev", "sig", "math", "os", "init", "gsl", "priv_hmac", "wire_rep_utils")
]

#: A device of our own in C++: the one that `inner` names, given on once it has heard of its server.
PATIENT = "patient"

_SOURCE = """
#include <yarp/dev/DeviceDriver.h>
#include <yarp/dev/Drivers.h>
#include <yarp/dev/IAnalogSensor.h>
#include <yarp/dev/IJoypadController.h>
#include <yarp/dev/PolyDriver.h>
#include <yarp/os/Network.h>
#include <yarp/os/Property.h>
#include <yarp/os/Time.h>
{declarations}
class Patient : public yarp::dev::DeviceDriver {{
    yarp::dev::PolyDriver driver;
    bool hasHeard() {{
        yarp::dev::IAnalogSensor* sensor = nullptr;
        if (driver.view(sensor)) return sensor->getChannels() > 0;
        yarp::dev::IJoypadController* pad = nullptr;
        double axis;
        return driver.view(pad) && pad->getAxis(0, axis);
    }}
public:
    bool open(yarp::os::Searchable& config) override {{
        yarp::os::Property options;
        options.fromString(config.toString());
        options.put("device", config.find("inner").asString());
        if (!driver.open(options)) return false;
        for (int wait = 0; wait < 2000 && !hasHeard(); wait++)
            yarp::os::Time::delay(0.01);
        return hasHeard();
    }}
    bool close() override {{ return driver.close(); }}
    yarp::dev::DeviceDriver* getImplementation() override {{ return driver.getImplementation(); }}
}};
int main(int argc, char* argv[]) {{
    yarp::os::Network network;
    {additions}
    yarp::dev::Drivers::factory().add(
        new yarp::dev::DriverCreatorOf<Patient>("{patient}", "", "Patient"));
    return yarp::dev::Drivers::factory().yarpdev(argc, argv);
}}
""".format(
    patient=PATIENT,
    declarations="\n".join(f"void add_owned_{name}(const char* owner);" for name in DEVICES),
    additions="\n    ".join(f'add_owned_{name}("host");' for name in DEVICES),
)


def device_host(cpp: CppYarp) -> Path:
    """A yarpdev with `DEVICES`; links it the first time. Or MissingPeer."""
    return linked(cpp, "devices", _SOURCE, _LIBRARIES)


@contextlib.contextmanager
def cpp_device(programs: CppYarp, device: str, **options: object) -> Iterator[Process]:
    """A C++ process with this device, opened with `--option value` for each of the options."""
    words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    command = [device_host(programs), "--device", device, *words]
    with Process(command, env=programs.environment, cwd=programs.home) as process:
        process.wait_line("device active in background|not available", timeout=30)
        yield process
