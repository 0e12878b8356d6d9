"""The virtual environment that holds ROS 2 itself: rclpy of Kilted, over Fast DDS.
See `peer_venv.py` for where it lies.

`python tests/support/rclpy_venv.py` prepares that environment and says where it is. The wheels are
for Python 3.11 and Linux.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.peer_venv import MissingPeer, install, make_once, peers_directory

PACKAGES = ("ros-kilted-rclpy", "ros-kilted-rmw-fastrtps-cpp", "ros-kilted-common-interfaces")
PYTHON = "/usr/bin/python3.11"


def directory() -> Path:
    """Where the environment is or would be made."""
    return peers_directory() / "rclpy-kilted"


def prepare() -> Path:
    """The Python of the environment; makes the environment if it is not there. Or MissingPeer."""
    ours = sys.version_info[:2] == (3, 11)
    python = sys.executable if ours else PYTHON
    if not ours and not Path(python).exists():
        raise MissingPeer(f"no {python}, for which rclpy's wheels are: apt-get install python3.11")
    found = directory()
    return make_once(found, lambda: install(python, found, *PACKAGES)) / "bin/python"


if __name__ == "__main__":
    try:
        print(prepare())
    except MissingPeer as missing:
        sys.exit(str(missing))
