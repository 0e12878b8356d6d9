"""The virtual environment that holds other libraries of Thrift: Apache's own, and thriftpy2, which
reads `.thrift` files as it runs. See `peer_venv.py` for where it lies.

`python tests/support/thrift_venv.py` prepares that environment and says where it is.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.peer_venv import MissingPeer, install, make_once, peers_directory

PACKAGES = ("thriftpy2>=0.6", "thrift>=0.21")


def directory() -> Path:
    """Where the environment is or would be made."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return peers_directory() / f"thrift-python{version}"


def prepare() -> Path:
    """The Python of the environment; makes the environment if it is not there. Or MissingPeer."""
    found = directory()
    return make_once(found, lambda: install(sys.executable, found, *PACKAGES)) / "bin/python"


if __name__ == "__main__":
    try:
        print(prepare())
    except MissingPeer as missing:
        sys.exit(str(missing))
