"""A program of Fast DDS, another implementation of DDS and the default of ROS 2, made on the spot.

Debian: apt-get install g++ libfastrtps-dev.
"""

import shutil
import subprocess
from pathlib import Path

from support.peer_venv import MissingPeer

SOURCE = Path(__file__).with_name("fast_dds.cpp")
INCLUDES = ("/usr/include", "/usr/local/include")


def build(folder: Path) -> Path:
    """The program, in `folder`. MissingPeer says what is not installed."""
    compiler = shutil.which("g++")
    if compiler is None:
        raise MissingPeer("no g++ here")
    if not any(Path(place, "fastdds/dds/domain").is_dir() for place in INCLUDES):
        raise MissingPeer("Fast DDS is not installed: apt-get install libfastrtps-dev")
    program = folder / "fast_dds"
    subprocess.run(
        [compiler, "-std=c++17", str(SOURCE), "-o", str(program), "-lfastrtps", "-lfastcdr"],
        check=True,
        capture_output=True,
        timeout=300,
    )
    return program
