"""The virtual environment that holds a real C++ YARP, made once per machine.

The package `yarp-middleware` carries compiled C++ YARP 3.5 (programs and Python binding) and needs
CPython 3.10. It gets an environment of its own outside this repository: below $YARPY_PEERS_DIR,
else $XDG_CACHE_HOME/yarpy-peers, else ~/.cache/yarpy-peers.

`python tests/support/cpp_venv.py` prepares that environment and says where it is.
Rules: standard library only (it runs before anything is installed); several processes may ask at
once, one installs; what is missing is said in one sentence that tells what to do.
"""

import contextlib
import fcntl
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

# The last one published. Older ones lack fixes, and a moving version would move the benchmarks.
PACKAGE = "yarp-middleware==3.5.1.dev316"


class MissingPeer(Exception):
    """C++ YARP cannot be had on this machine; the text says why and what to do."""


def environment_directory() -> Path:
    """Where the environment is or would be made."""
    peers = os.environ.get("YARPY_PEERS_DIR")
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return (Path(peers) if peers else Path(cache) / "yarpy-peers") / PACKAGE.replace("==", "-")


def prepare() -> Path:
    """The environment's directory; makes the environment if it is not there. Or MissingPeer."""
    directory = environment_directory()
    ready = directory / ".ready"
    if ready.exists():
        return directory
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        lock = (directory.parent / f"{directory.name}.lock").open("w")
    except OSError as error:
        raise MissingPeer(
            f"cannot write {directory.parent}: {error}; set YARPY_PEERS_DIR"
        ) from error
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if ready.exists():  # another process made it while we waited
            return directory
        shutil.rmtree(directory, ignore_errors=True)
        _run([str(_find_python()), "-m", "venv", str(directory)], "make a virtual environment")
        pip = [str(directory / "bin/python"), "-m", "pip", "--disable-pip-version-check"]
        _run([*pip, "install", "--quiet", "--pre", PACKAGE], f"install {PACKAGE}")
        _run([str(directory / "bin/yarp"), "version"], "start the C++ programs")
        ready.touch()
    return directory


def _find_python() -> Path:
    """A CPython 3.10 that really runs (a pyenv shim may be on PATH and still refuse)."""
    for candidate in _candidates():
        probe = "import sys; print(sys.implementation.name, *sys.version_info[:2])"
        with contextlib.suppress(OSError, subprocess.TimeoutExpired):
            answer = subprocess.run(
                [str(candidate), "-c", probe],
                env=_environment(),
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


def _environment() -> dict[str, str]:
    """Ours without what points a Python at the modules of another one."""
    return {k: v for k, v in os.environ.items() if k not in ("PYTHONHOME", "PYTHONPATH")}


def _run(command: list[str], purpose: str) -> None:
    try:
        subprocess.run(
            command, env=_environment(), check=True, capture_output=True, text=True, timeout=300
        )
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines() or ["no message"]
        reason = next((line for line in words if line.startswith("ERROR")), words[-1])
        raise MissingPeer(f"could not {purpose} for C++ YARP as a peer: {reason}") from error
    except (OSError, subprocess.TimeoutExpired) as error:
        raise MissingPeer(f"could not {purpose} for C++ YARP as a peer: {error}") from error


if __name__ == "__main__":
    try:
        print(f"C++ YARP is in {prepare()}")
    except MissingPeer as missing:
        sys.exit(str(missing))
