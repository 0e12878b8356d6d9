"""`yarpdatadumper --name /dump/head --connect /icub/head/state:o`: record one port into a folder.

    --name PORT (/dump)   --connect SOURCE   --dir FOLDER   --overwrite   --downsample N
    --type bottle|image|image_jpg|image_png|depth|depth_compressed   --rxTime   --txTime

Rules: `NAME` takes what comes, `NAME/rpc` knows `quit`. The folder, below the working directory, is
called like the port, and is one that C++ yarpdataplayer reads; everything is on the disk a second
later. What comes faster than the disk takes it is lost after 256 MB, and counted. For more than one
port, and for messages as they were, there is `yarpy record`.
"""

from __future__ import annotations

import sys
from functools import partial
from typing import Final, NoReturn

import yarpy
from yarp._log import print_lines
from yarpy.data.text import plain_text
from yarpy.kits import record

EXIT_USAGE: Final = 1
SECOND: Final = 1_000_000_000  # nanoseconds
#: the types of folders, by `--type`
TYPES: Final = {
    "bottle": "Bottle",
    "image": "Image",
    "image_jpg": "Image:jpg",
    "image_png": "Image:png",
    "depth": "Depth",
    "depth_compressed": "DepthCompressed",
}


class Dumper(yarpy.Module):
    """A recorder of one port as a program."""

    name = "/dump"
    period = 0.1

    def configure(self, resources: yarpy.ResourceFinder) -> bool:
        self.failed = False
        if not self.name.startswith("/"):
            self.name = f"/{self.name}"
        wanted = plain_text(resources.find("type") or "bottle")
        if wanted not in TYPES:
            known = ", ".join(TYPES)
            said = ": films are not written" if wanted == "video" else ""
            return _give_up(f"no type {wanted!r}{said}; there are {known}")
        if resources.check("addVideo"):
            _say("WARNING", "--addVideo: films are not written, the pictures are")
        overwrite = resources.check("overwrite")
        folder = plain_text(resources.find("dir") or self.name)
        path = record.classical_folder(folder, overwrite)
        received, sent = resources.check("rxTime"), resources.check("txTime")
        every = resources.find("downsample")
        opened = partial(
            record.SingleFolder,
            type_=TYPES[wanted],
            times="tx+rx" if received and sent else "rx" if received else "tx" if sent else "",
            every=every if isinstance(every, int) else 1,
            overwrite=overwrite,
        )
        self.recorder = record.Recorder(
            path=path, name=self.name, format=opened, now=_now, tell=partial(_say, "WARNING")
        )
        _say("INFO", f"Service yarp port:  {self.name}")
        _say("INFO", f"Data stored in   :  ./{path.as_posix()}")
        source = plain_text(resources.find("connect") or "")
        if source:
            try:
                yarpy.connect(source, self.name, "tcp")
            except yarpy.YarpError as error:
                _say("WARNING", f"{source} cannot be connected, others may be: {error}")
        return True

    def update(self) -> bool:
        return not self.recorder.ended.is_set

    def respond(self, request: yarpy.Bottle) -> object:
        if request and plain_text(request[0]) in ("quit", "exit", "bye"):
            return None
        return yarpy.Bottle(["command not recognized"] * 2)

    def close(self) -> None:
        self.recorder.close()
        self.failed = bool(self.recorder.failure)
        kept = self.recorder.messages
        _say("INFO", f"{kept}  items stored [cumul #:  {kept} ]")
        if self.recorder.lost:
            _say("WARNING", f"{self.recorder.lost} could not be stored")


def _now() -> int:
    """The clock of YARP_CLOCK, if there is one."""
    return round(yarpy.clock.now() * SECOND)


def _say(level: str, line: str) -> None:
    print(f"[{level}] {line}", file=sys.stderr, flush=True)


def _give_up(why: str) -> bool:
    print(f"error: yarpdatadumper: {why}", file=sys.stderr)
    return False


def main() -> NoReturn:
    """The program `yarpdatadumper`."""
    if {"-h", "--help"} & {*sys.argv[1:]}:
        print_lines([__doc__ or ""])
        sys.exit(0)
    dumper = Dumper()
    try:
        code = dumper.run(yarpy.ResourceFinder(sys.argv[1:]))
    except (yarpy.YarpError, OSError) as error:
        print(f"error: yarpdatadumper: {error}", file=sys.stderr)
        code = EXIT_USAGE
    sys.exit(code or int(getattr(dumper, "failed", False)))
