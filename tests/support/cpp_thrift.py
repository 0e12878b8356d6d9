"""A C++ program that speaks Thrift: what `yarpidl_thrift` makes of capt.thrift, and a few lines.

    program = thrift_peer(cpp)                   # MissingPeer says why there is none
    Process([program, "server", "/cpp"], ...)    # gives back what it gets
    Process([program, "client", "/server"], ...) # calls, and prints what it is answered

Rules: compiled once, and kept beside the virtual environment. The C++ of version 3.5 for lists of
bool cannot be compiled, so they are left out.
"""

import hashlib
import os
import shutil
import subprocess
from pathlib import Path

from support.cpp import CppYarp
from support.file_lock import hold
from support.peer_venv import MissingPeer
from support.thrift import GOLDEN

SOURCE = Path(__file__).with_name("thrift_peer.cpp")
INTERFACE = (
    (GOLDEN / "capt.thrift")
    .read_text()
    .replace("1: list<bool> lb, ", "")
    .replace("list<bool> r_lbool(1: list<bool> v);", "")
)
_LIBRARIES = ("os", "sig", "math", "dev", "init", "gsl", "priv_hmac", "wire_rep_utils")


def thrift_peer(cpp: CppYarp) -> Path:
    """The program. It is compiled the first time, which takes half a minute. Or MissingPeer."""
    compiler = shutil.which(os.environ.get("CXX", "g++"))
    if compiler is None:
        raise MissingPeer("a C++ peer has to be compiled: install g++, or name it in CXX")
    mark = hashlib.sha256((SOURCE.read_text() + INTERFACE).encode()).hexdigest()[:12]
    target = cpp.root.parent / f"{cpp.root.name}-thrift-{mark}"
    with (cpp.root.parent / f"{target.name}.lock").open("w") as lock:
        hold(lock)
        if not target.exists():
            _compile(cpp, compiler, target)
    return target


def _compile(cpp: CppYarp, compiler: str, target: Path) -> None:
    generated = target.with_suffix(".generated")
    shutil.rmtree(generated, ignore_errors=True)
    generated.mkdir()
    file = generated / "capt.thrift"
    file.write_text(INTERFACE)
    packages = cpp.root / "lib/python3.10/site-packages"
    libraries = packages / "yarp/lib"
    foreign = sorted((packages / "yarp_middleware.libs").glob("libACE*.so*"))
    half_done = target.with_suffix(".part")
    makes = [cpp.program("yarpidl_thrift"), "--gen", "yarp", "--out", generated, file]
    command = [
        *(compiler, "-std=c++17", "-O0", f"-I{generated}", f"-I{packages / 'yarp/include'}"),
        *("-o", str(half_done), str(SOURCE), "-Wl,--start-group"),
        *(str(libraries / f"libYARP_{name}.a") for name in _LIBRARIES),
        *("-Wl,--end-group", *map(str, foreign)),
        *(f"-Wl,-rpath,{packages / 'yarp_middleware.libs'}", "-lz", "-lpthread", "-ldl"),
    ]
    try:
        subprocess.run(makes, check=True, capture_output=True, text=True, timeout=60)
        command[5:5] = sorted(map(str, generated.glob("*.cpp")))
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=400)
    except subprocess.CalledProcessError as error:
        line = error.stderr.strip().splitlines()[-1:]
        raise MissingPeer(f"could not compile the C++ peer: {' '.join(line)}") from error
    half_done.replace(target)
    shutil.rmtree(generated)
