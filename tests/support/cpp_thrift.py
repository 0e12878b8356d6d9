"""A C++ program that speaks Thrift: what `yarpidl_thrift` makes of capt.thrift, and a few lines.

    program = thrift_peer(cpp)                   # MissingPeer says why there is none
    Process([program, "server", "/cpp"], ...)    # gives back what it gets
    Process([program, "client", "/server"], ...) # calls, and prints what it is answered

Rules: compiled once, and kept beside the virtual environment. The C++ of version 3.5 for lists of
bool cannot be compiled, so they are left out.
"""

import hashlib
import shutil
import subprocess
from pathlib import Path

from support.cpp import CppYarp
from support.cpp_link import compiled
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


def thrift_peer(cpp: CppYarp) -> Path:
    """The program. It is compiled the first time, which takes half a minute. Or MissingPeer."""
    mark = hashlib.sha256((SOURCE.read_text() + INTERFACE).encode()).hexdigest()[:12]
    target = cpp.root.parent / f"{cpp.root.name}-thrift-{mark}"
    with (cpp.root.parent / f"{target.name}.lock").open("w") as lock:
        hold(lock)
        if not target.exists():
            _compile(cpp, target)
    return target


def _compile(cpp: CppYarp, target: Path) -> None:
    generated = target.with_name(f"{target.name}.generated")
    shutil.rmtree(generated, ignore_errors=True)
    generated.mkdir()
    file = generated / "capt.thrift"
    file.write_text(INTERFACE)
    makes = [cpp.program("yarpidl_thrift"), "--gen", "yarp", "--out", generated, file]
    try:
        subprocess.run(makes, check=True, capture_output=True, text=True, timeout=60)
    except subprocess.CalledProcessError as error:
        line = error.stderr.strip().splitlines()[-1:]
        raise MissingPeer(f"could not make the C++ peer: {' '.join(line)}") from error
    files = [SOURCE, *sorted(generated.glob("*.cpp"))]
    libraries = [f"YARP_{name}" for name in ("math", "sig", "os", "init")]
    compiled(cpp, target, files, libraries, "-O0", f"-I{generated}")
    shutil.rmtree(generated)
