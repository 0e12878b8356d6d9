"""C++ YARP's own `yarp`, with a carrier that it brings but has not linked.

yarp = carrier_program(cpp, "shmem")         # MissingPeer says why there is none
cpp.popen("read", "/cpp", program=yarp)
"""

import pytest
from support.cpp import CppYarp
from support.cpp_link import linked

_SOURCE = """
#include <yarp/companion/yarpcompanion.h>
#include <yarp/os/Network.h>
int main(int argc, char* argv[]) {
    yarp::os::Network network(yarp::os::YARP_CLOCK_SYSTEM);
    add_plugins();
    return yarp::companion::main(argc, argv);
}
"""
_LIBRARIES = ("YARP_companion", "YARP_sig", "YARP_os", "YARP_init")


def carrier_program(cpp: CppYarp, carrier: str) -> str:
    """A `yarp` with `carrier`, for `popen(..., program=)`. Or MissingPeer."""
    needs(cpp, carrier)
    return str(linked(cpp, carrier, _SOURCE, [carrier], _LIBRARIES))


def needs(cpp: CppYarp, carrier: str) -> None:
    """Skip the test where an installation was built without this plugin."""
    if cpp.package is None and not (cpp.root / f"share/yarp/plugins/{carrier}.ini").exists():
        pytest.skip(f"{cpp.root} has no carrier {carrier}: build it there, if it is not too new")
