"""Programs linked from what the package with the C++ programs brings: static libraries and headers.

    linked(cpp, "devices", source, ["yarp_fakeFrameGrabber"], ["YARP_dev", "YARP_os"])

They are linked once, and kept beside the virtual environment.
"""

import hashlib
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from support.cpp import CppYarp
from support.file_lock import hold
from support.peer_venv import MissingPeer


def linked(cpp: CppYarp, name: str, source: str, libraries: Sequence[str]) -> Path:
    """The program whose main function is in `source`; links it the first time. Or MissingPeer."""
    compiler = shutil.which(os.environ.get("CXX", "g++"))
    if compiler is None:
        raise MissingPeer(f"C++ {name} as a peer has to be linked: install g++, or name it in CXX")
    packages = cpp.root / "lib/python3.10/site-packages"
    mark = hashlib.sha256(source.encode()).hexdigest()[:12]
    target = cpp.root.parent / f"{cpp.root.name}-{name}-{mark}"
    with (cpp.root.parent / f"{target.name}.lock").open("w") as lock:
        hold(lock)
        if not target.exists():
            _link(compiler, packages, target, source, libraries)
    return target


def _link(
    compiler: str, packages: Path, target: Path, source: str, libraries: Sequence[str]
) -> None:
    file = target.with_suffix(".cpp")
    file.write_text(source)
    half_done = target.with_suffix(".part")
    foreign = sorted((packages / "yarp_middleware.libs").glob("libACE*.so*"))
    command = [
        *(compiler, "-std=c++17", f"-I{packages / 'yarp/include'}", str(file)),
        *("-o", str(half_done), "-Wl,--start-group"),
        *(str(packages / f"yarp/lib/lib{name}.a") for name in libraries),
        *("-Wl,--end-group", *map(str, foreign)),
        *(f"-Wl,-rpath,{packages / 'yarp_middleware.libs'}", "-lz", "-lpthread", "-ldl"),
    ]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=300)
    except subprocess.CalledProcessError as error:
        line = error.stderr.strip().splitlines()[-1:]
        raise MissingPeer(f"could not link {target.name}: {' '.join(line)}") from error
    half_done.replace(target)
