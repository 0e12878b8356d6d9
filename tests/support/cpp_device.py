"""C++ YARP's own robot devices as peers: controlBoard_nws_yarp, remote_controlboard and others.

    host = device_host(cpp)                      # MissingPeer says why there is none
    with cpp_device(programs, "controlBoard_nws_yarp", subdevice="remote_controlboard", ...) as p:
        ...

The package with the C++ programs brings its devices as static libraries and with headers, but has
linked none of them into its `yarpdev`. So one is linked here, from a main function of a few lines,
and kept beside the virtual environment.
"""

import contextlib
import fcntl
import hashlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

from support.cpp import CppYarp
from support.cpp_venv import MissingPeer
from support.process import Process

DEVICES = (
    "remote_controlboard",
    "controlBoard_nws_yarp",
    "frameGrabber_nws_yarp",
    "frameGrabber_nwc_yarp",
    "fakeFrameGrabber",
    "multipleanalogsensorsserver",
    "multipleanalogsensorsclient",
)
_LIBRARIES = ("dev", "sig", "math", "os", "init", "gsl", "priv_hmac", "wire_rep_utils")

_SOURCE = """
#include <yarp/dev/Drivers.h>
#include <yarp/os/Network.h>
{declarations}
int main(int argc, char* argv[]) {{
    yarp::os::Network network;
    {additions}
    return yarp::dev::Drivers::factory().yarpdev(argc, argv);
}}
""".format(
    declarations="\n".join(f"void add_owned_{name}(const char* owner);" for name in DEVICES),
    additions="\n    ".join(f'add_owned_{name}("host");' for name in DEVICES),
)


def device_host(cpp: CppYarp) -> Path:
    """A yarpdev with `DEVICES`; links it the first time. Or MissingPeer."""
    compiler = shutil.which(os.environ.get("CXX", "g++"))
    if compiler is None:
        raise MissingPeer("C++ devices as peers have to be linked: install g++, or name it in CXX")
    packages = cpp.root / "lib/python3.10/site-packages"
    mark = hashlib.sha256(_SOURCE.encode()).hexdigest()[:12]
    target = cpp.root.parent / f"{cpp.root.name}-devices-{mark}"
    with (cpp.root.parent / f"{target.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not target.exists():
            _link(compiler, packages, target)
    return target


def _link(compiler: str, packages: Path, target: Path) -> None:
    source = target.with_suffix(".cpp")
    source.write_text(_SOURCE)
    half_done = target.with_suffix(".part")
    libraries = packages / "yarp/lib"
    foreign = sorted((packages / "yarp_middleware.libs").glob("libACE*.so*"))
    command = [
        *(compiler, "-std=c++17", f"-I{packages / 'yarp/include'}", str(source)),
        *("-o", str(half_done), "-Wl,--start-group"),
        *(str(libraries / f"libyarp_{name}.a") for name in DEVICES),
        *(str(libraries / f"libYARP_{name}.a") for name in _LIBRARIES),
        *("-Wl,--end-group", *map(str, foreign)),
        *(f"-Wl,-rpath,{packages / 'yarp_middleware.libs'}", "-lz", "-lpthread", "-ldl"),
    ]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=300)
    except subprocess.CalledProcessError as error:
        line = error.stderr.strip().splitlines()[-1:]
        raise MissingPeer(f"could not link C++ devices as peers: {' '.join(line)}") from error
    half_done.replace(target)


@contextlib.contextmanager
def cpp_device(programs: CppYarp, device: str, **options: object) -> Iterator[Process]:
    """A C++ process with this device, opened with `--option value` for each of the options."""
    words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    command = [device_host(programs), "--device", device, *words]
    with Process(command, env=programs.environment, cwd=programs.home) as process:
        process.wait_line("device active in background|not available", timeout=30)
        yield process
