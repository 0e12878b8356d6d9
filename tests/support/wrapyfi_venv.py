"""The virtual environment that holds Wrapyfi, made once per machine.

Wrapyfi's own tests of YARP run in it with yarpy and compat of this checkout in place of C++ YARP.
It lies where that of C++ YARP does: see `cpp_venv.py`, whose rules are these, too.

`python tests/support/wrapyfi_venv.py` prepares that environment and says where it is.
"""

import fcntl
import os
import shutil
import subprocess
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.cpp_venv import MissingPeer, environment_directory

# Without OpenCV Wrapyfi falls back to nothing and says little about it.
PACKAGES = (
    "wrapyfi==0.5.0",
    "opencv-python-headless>=4.10",
    "pyzmq>=26",
    "eclipse-zenoh>=1.4",
    "paho-mqtt>=2",
    "python-socketio[client]>=5.11",
)


def directory() -> Path:
    """Where the environment is or would be made."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    name = f"{PACKAGES[0].replace('==', '-')}-python{version}-{len(PACKAGES)}"
    return environment_directory().parent / name


def prepare() -> Path:
    """The environment's directory; makes the environment if it is not there. Or MissingPeer."""
    found = directory()
    ready = found / ".ready"
    if ready.exists():
        return found
    try:
        found.parent.mkdir(parents=True, exist_ok=True)
        lock = (found.parent / f"{found.name}.lock").open("w")
    except OSError as error:
        raise MissingPeer(f"cannot write {found.parent}: {error}; set YARPY_PEERS_DIR") from error
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if ready.exists():
            return found
        shutil.rmtree(found, ignore_errors=True)
        _run([sys.executable, "-m", "venv", str(found)], "make a virtual environment")
        pip = [str(found / "bin/python"), "-m", "pip", "--disable-pip-version-check", "install"]
        root = Path(__file__).parents[2]
        needed = _needed(root / "pyproject.toml")
        _run([*pip, "--quiet", *PACKAGES, *needed], f"install {PACKAGES[0]}")
        ready.touch()
    return found


def _needed(project: Path) -> list[str]:
    """What yarpy itself needs; it is taken from this checkout by PYTHONPATH."""
    import tomllib

    found: list[str] = tomllib.loads(project.read_text())["project"]["dependencies"]
    return found


def _run(command: list[str], purpose: str) -> None:
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONHOME", "PYTHONPATH")}
    try:
        subprocess.run(
            command, env=environment, check=True, capture_output=True, text=True, timeout=300
        )
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines() or ["no message"]
        raise MissingPeer(f"could not {purpose}: {words[-1]}") from error
    except (OSError, subprocess.TimeoutExpired) as error:
        raise MissingPeer(f"could not {purpose}: {error}") from error


if __name__ == "__main__":
    try:
        print(f"Wrapyfi is in {prepare()}")
    except MissingPeer as missing:
        sys.exit(str(missing))
