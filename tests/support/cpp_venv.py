"""The directory that holds a real C++ YARP: one that is named, else a virtual environment.

    YARPY_CPP_YARP=/opt/yarp make peers      # the same tests beside another version

The variable names the prefix of an installation with shared libraries, programs, devices and
carriers, which is also a virtual environment whose `bin/python` imports the binding. Without it,
the package `yarp-middleware` carries compiled C++ YARP 3.5 (programs and Python binding), which
needs CPython 3.10; see `peer_venv.py` for where it lies.

`python tests/support/cpp_venv.py` prepares that environment and says where it is.
"""

import contextlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.peer_venv import MissingPeer, environment, install, make_once, peers_directory, run

# The last one published. Older ones lack fixes, and a moving version would move the benchmarks.
PACKAGE = "yarp-middleware==3.5.1.dev316"


def environment_directory() -> Path:
    """Where the environment is or would be made."""
    return peers_directory() / PACKAGE.replace("==", "-")


def prepare() -> Path:
    """The directory; makes the environment if none is named and none there. Or MissingPeer."""
    if named := os.environ.get("YARPY_CPP_YARP"):
        return _installation(Path(named))
    directory = environment_directory()

    def fill() -> None:
        install(_find_python(), directory, "--pre", PACKAGE)
        run([str(directory / "bin/yarp"), "version"], "start the programs of C++ YARP")

    return make_once(directory, fill)


def _installation(prefix: Path) -> Path:
    for name in ("bin/yarp", "bin/python"):
        if not (prefix / name).exists():
            raise MissingPeer(f"YARPY_CPP_YARP has no {name}: name a prefix as cpp_venv.py says")
    run([str(prefix / "bin/yarp"), "version"], "start the programs of C++ YARP")
    return prefix


def _find_python() -> Path:
    """A CPython 3.10 that really runs (a pyenv shim may be on PATH and still refuse)."""
    for candidate in _candidates():
        probe = "import sys; print(sys.implementation.name, *sys.version_info[:2])"
        with contextlib.suppress(OSError, subprocess.TimeoutExpired):
            answer = subprocess.run(
                [str(candidate), "-c", probe],
                env=environment(),
                capture_output=True,
                text=True,
                timeout=20,
            )
            if answer.stdout.split() == ["cpython", "3", "10"]:
                return candidate
    raise MissingPeer(
        "C++ YARP as a peer needs CPython 3.10 and none was found: put python3.10 on PATH, install "
        "one with pyenv or uv, or name one in YARPY_PYTHON310"
    )


def _candidates() -> Iterator[Path]:
    if named := os.environ.get("YARPY_PYTHON310"):
        yield Path(named)
    if on_path := shutil.which("python3.10"):
        yield Path(on_path)
    home = Path.home()
    pyenv = Path(os.environ.get("PYENV_ROOT") or home / ".pyenv")
    managed_by_uv = Path(os.environ.get("UV_PYTHON_INSTALL_DIR") or home / ".local/share/uv/python")
    yield from sorted(pyenv.glob("versions/3.10*/bin/python"), reverse=True)
    yield from sorted(managed_by_uv.glob("cpython-3.10*/bin/python3.10"), reverse=True)
    yield Path("/usr/local/bin/python3.10")


if __name__ == "__main__":
    try:
        print(f"C++ YARP is in {prepare()}")
    except MissingPeer as missing:
        sys.exit(str(missing))
