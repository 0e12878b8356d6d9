"""The environment of this process while it plays a part among C++ programs."""

import contextlib
import os
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp

_PEERS = ("YARPY_PEERS_DIR", "YARPY_CPP_YARP")


@contextlib.contextmanager
def configured_for(programs: CppYarp, by_file: bool) -> Iterator[None]:
    """Nothing of the machine's own YARP configuration, and the name server of `programs`.

    `by_file`: found through yarp.conf in YARP_CONFIG_HOME, as C++ does; else YARPY_SERVER.
    """
    with pytest.MonkeyPatch.context() as patch:
        for name in list(os.environ):
            if name.startswith(("YARP_", "YARPY_", "ROS_")) and name not in _PEERS:
                patch.delenv(name)
        patch.setenv("YARP_CONFIG_HOME", str(programs.home / "config"))
        patch.setenv("YARP_DATA_HOME", str(programs.home / "data"))
        if not by_file:
            patch.setenv("YARPY_SERVER", f"{programs.host}:{programs.port}")
        yield
