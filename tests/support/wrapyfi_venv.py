"""The virtual environment that holds Wrapyfi. See `peer_venv.py` for where it lies.

Wrapyfi's own tests of YARP run in it with yarpy and compat of this checkout in place of C++ YARP.

`python tests/support/wrapyfi_venv.py` prepares that environment and says where it is.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.peer_venv import MissingPeer, install, make_once, peers_directory

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
    return peers_directory() / name


def prepare() -> Path:
    """The environment's directory; makes the environment if it is not there. Or MissingPeer."""
    found = directory()
    return make_once(found, lambda: install(sys.executable, found, *PACKAGES, *_needed()))


def _needed() -> list[str]:
    """What yarpy itself needs; it is taken from this checkout by PYTHONPATH."""
    import tomllib

    project = Path(__file__).parents[2] / "pyproject.toml"
    found: list[str] = tomllib.loads(project.read_text())["project"]["dependencies"]
    return found


if __name__ == "__main__":
    try:
        print(f"Wrapyfi is in {prepare()}")
    except MissingPeer as missing:
        sys.exit(str(missing))
