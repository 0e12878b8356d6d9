"""C++ YARP's own `yarp`, with the carrier `shmem`, which the package brings but has not linked.

yarp = shmem_program(cpp)                    # MissingPeer says why there is none
cpp.popen("read", "/cpp", program=yarp)
"""

from support.cpp import CppYarp
from support.cpp_link import linked

_SOURCE = """
#include <yarp/companion/yarpcompanion.h>
#include <yarp/os/Network.h>
void add_owned_shmem(const char* owner);
int main(int argc, char* argv[]) {
    yarp::os::Network network(yarp::os::YARP_CLOCK_SYSTEM);
    add_owned_shmem("host");
    return yarp::companion::main(argc, argv);
}
"""
_LIBRARIES = [
    "yarp_shmem",
    *(f"YARP_{name}" for name in ("companion", "os", "init", "priv_hmac", "wire_rep_utils")),
]


def shmem_program(cpp: CppYarp) -> str:
    """A `yarp` with that carrier, for `popen(..., program=)`. Or MissingPeer."""
    return str(linked(cpp, "shmem", _SOURCE, _LIBRARIES))
