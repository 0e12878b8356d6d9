"""`yarpdev --device NAME ...`: keeps a device open until it is asked to end.

    yarpdev --device remote_controlboard --remote /robot/head --local /me
    yarpdev --device controlBoard_nws_yarp --name /cpp/head --subdevice remote_controlboard
            --remote /robot/head --local /me
    yarpdev --device fakeFrameGrabber --name /grabber
    yarpdev --from file.ini            options in a file; yarpdev --list shows the devices

Rules: a device that is not served by itself gets its usual server. `NAME/quit` ends it, and so do
SIGINT and SIGTERM. It says every three seconds that it is there. A `subdevice` is opened with the
same options and handed to the device.
"""

from __future__ import annotations

import sys
from typing import NoReturn

import yarpy
from yarp._log import print_lines
from yarp._poly_driver import DEVICES, WRAPPERS, PolyDriver
from yarp._property import Property

EXIT_USAGE = 1


class Yarpdev(yarpy.Module):
    """A device as a program."""

    period = 3.0

    def __init__(self) -> None:
        self.driver = PolyDriver()
        self.inner = PolyDriver()

    def configure(self, resources: yarpy.ResourceFinder) -> bool:
        options = Property(resources.values.to_text())
        device = options.find("device").asString()
        inner = options.find("subdevice").asString()
        if not inner and device in WRAPPERS:
            inner = device
            options.put("device", WRAPPERS[device])
            if not options.check("name"):
                options.put("name", "/grabber" if "rabber" in device else f"/{device}")
        if inner:
            below = Property(options)
            below.put("device", inner)
            if not self.inner.open(below):
                return False
        if not self.driver.open(options) or (inner and not self.driver.attach(self.inner)):
            self.inner.close()
            self.driver.close()
            return False
        # The devices have ports called NAME/rpc of their own.
        name, self.name = options.find("name").asString() or f"/{device}", ""
        self.ending = yarpy.RpcServer(f"{name}/quit", self._end)
        return True

    def _end(self, message: yarpy.Message) -> list[yarpy.Vocab]:
        if self.answer(message.as_(yarpy.Bottle)) != ["bye"]:
            return [yarpy.Vocab("huh?")]
        return [yarpy.Vocab("ok")]

    def update(self) -> None:
        print("[INFO] device active in background...", flush=True)

    def close(self) -> None:
        self.ending.close()
        self.driver.close()
        self.inner.close()
        print("yarpdev is finished.", flush=True)


def main() -> NoReturn:
    """The program `yarpdev`."""
    if "--list" in sys.argv[1:]:
        print_lines(sorted(DEVICES))
        sys.exit(0)
    try:
        finder = yarpy.ResourceFinder(sys.argv[1:])
        name = str(finder.find("device") or "")
        if not name:
            print_lines([__doc__ or ""])
            print("[WARNING] --device option not specified. Closing.", file=sys.stderr)
            sys.exit(0)
        code = Yarpdev().run(finder)
    except (yarpy.YarpError, OSError) as error:
        print(f"error: yarpdev: {error}", file=sys.stderr)
        code = EXIT_USAGE
    if code:
        print(
            f"yarpdev: ***ERROR*** device not available; there are {', '.join(sorted(DEVICES))}",
            file=sys.stderr,
        )
    sys.exit(code)
