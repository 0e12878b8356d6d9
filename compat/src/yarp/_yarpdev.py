"""`yarpdev --device NAME ...`: keeps a device open until it is asked to end.

    yarpdev --device remote_controlboard --remote /robot/head --local /me
    yarpdev --device controlBoard_nws_yarp --name /cpp/head --subdevice remote_controlboard
            --remote /robot/head --local /me
    yarpdev --device fakeFrameGrabber --name /grabber
    yarpdev --from file.ini            options in a file; yarpdev --list shows the devices

Rules: the types are those of `yarpy dev`, which opens and serves them. `NAME/quit` ends it, and so
do SIGINT and SIGTERM. It says every three seconds that it is there.
"""

from __future__ import annotations

import sys
from typing import NoReturn

import yarpy
from yarp._log import print_lines
from yarpy.kits.devices.catalogue import lines
from yarpy.kits.devices.wrapper import server_of
from yarpy.kits.launch.robot.standalone import StandaloneDevice
from yarpy.registry import devices

EXIT_USAGE = 1


class Yarpdev(yarpy.Module):
    """A device as a program."""

    period = 3.0

    def configure(self, resources: yarpy.ResourceFinder) -> bool:
        self.opened = StandaloneDevice(resources.values, devices.load, server_of)
        # The devices have ports called NAME/rpc of their own.
        self.name = ""
        try:
            self.ending = yarpy.RpcServer(f"{self.opened.name.rstrip('/')}/quit", self._end)
        except BaseException:
            self.opened.close()
            raise
        return True

    def _end(self, message: yarpy.Message) -> list[yarpy.Vocab]:
        if self.answer(message.as_(yarpy.Bottle)) != ["bye"]:
            return [yarpy.Vocab("huh?")]
        return [yarpy.Vocab("ok")]

    def update(self) -> None:
        print("[INFO] device active in background...", flush=True)

    def close(self) -> None:
        self.ending.close()
        self.opened.close()
        print("yarpdev is finished.", flush=True)


def run(arguments: list[str]) -> int:
    """Be the program with these arguments; return its exit code."""
    if "--list" in arguments:
        print_lines(["Here are devices listed for your system:", "", *lines()])
        return 0
    try:
        finder = yarpy.ResourceFinder(arguments)
        if not finder.find("device"):
            print_lines([__doc__ or ""])
            print("[WARNING] --device option not specified. Closing.", file=sys.stderr)
            return 0
        code = Yarpdev().run(finder)
    except Exception as error:  # whatever a driver raises
        print(f"error: yarpdev: {error or type(error).__name__}", file=sys.stderr)
        code = EXIT_USAGE
    if code:
        print(
            "yarpdev: ***ERROR*** device not available. yarpdev --list shows those that are.",
            file=sys.stderr,
        )
    return code


def main() -> NoReturn:
    """The program `yarpdev`."""
    sys.exit(run(sys.argv[1:]))
