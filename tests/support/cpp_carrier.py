"""C++ YARP's own `yarp`, with a carrier that the package brings but has not linked.

yarp = carrier_program(cpp, "shmem")         # MissingPeer says why there is none
cpp.popen("read", "/cpp", program=yarp)
"""

from support.cpp import CppYarp
from support.cpp_link import linked

_SOURCE = """
#include <yarp/companion/yarpcompanion.h>
#include <yarp/os/Network.h>
void add_owned_NAME(const char* owner);
int main(int argc, char* argv[]) {
    yarp::os::Network network(yarp::os::YARP_CLOCK_SYSTEM);
    add_owned_NAME("host");
    return yarp::companion::main(argc, argv);
}
"""
_LIBRARIES = [
    f"YARP_{name}" for name in ("companion", "sig", "os", "init", "priv_hmac", "wire_rep_utils")
]


def carrier_program(cpp: CppYarp, carrier: str) -> str:
    """A `yarp` with `carrier`, for `popen(..., program=)`. Or MissingPeer."""
    source = _SOURCE.replace("NAME", carrier)
    return str(linked(cpp, carrier, source, [f"yarp_{carrier}", *_LIBRARIES]))
