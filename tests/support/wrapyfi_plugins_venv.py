"""The virtual environment that holds Wrapyfi and the libraries of its plug-ins. See `peer_venv.py`.

`python tests/support/wrapyfi_plugins_venv.py` prepares that environment and says where it is.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.peer_venv import MissingPeer, install, make_once, peers_directory

PACKAGES = (
    "wrapyfi==0.5.0",
    "pillow>=10",
    "pandas>=2",
    "xarray",
    "pint",
    "dask[array,dataframe]",
    "zarr>=3",
    "pyarrow",
    "jax",
    *("click", "h11", "rich", "simplejpeg"),  # what yarpy itself needs
)


def directory() -> Path:
    """Where the environment is or would be made."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return peers_directory() / f"wrapyfi-plugins-python{version}-{len(PACKAGES)}"


def prepare() -> Path:
    """The environment's directory; makes the environment if it is not there. Or MissingPeer."""
    found = directory()
    return make_once(found, lambda: install(sys.executable, found, *PACKAGES))


def ready() -> Path:
    """The environment's directory, if somebody made it: half a gigabyte is not loaded by a test.
    Or MissingPeer."""
    if not (directory() / ".ready").exists():
        raise MissingPeer(
            "no libraries of Wrapyfi's plug-ins: python tests/support/wrapyfi_plugins_venv.py"
        )
    return directory()


if __name__ == "__main__":
    try:
        print(f"Wrapyfi and the libraries of its plug-ins are in {prepare()}")
    except MissingPeer as missing:
        sys.exit(str(missing))
