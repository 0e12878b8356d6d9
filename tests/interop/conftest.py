"""The C++ side of the interoperation tests.

`cpp` is a real C++ YARP without a name server, for the session; `cpp_server` adds a C++ name server
of its own to each test. `network` is a place where yarpy ports of this process and C++ programs
meet: a test that takes it runs twice, around a yarpy name server and around a C++ one; `our_names`
and `cpp_names` are only the one or the other. `peer` is a C++ program in that place, `side` one
that has run the text SIDE of its file of tests, which opens `/cpp`; `port` talks to that. All skip
with the reason where C++ YARP cannot be had. `names`, `out` and `reader` are of this process.
"""

import contextlib
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.peer import brings
from support.port import free_block

import yarpy


@pytest.fixture(scope="session")
@brings("cpp")
def cpp(tmp_path_factory: pytest.TempPathFactory) -> CppYarp:
    """C++ YARP: `cpp.server()`, `cpp.at(host, port)`, then run, popen, python on the result."""
    return CppYarp.prepare(tmp_path_factory.mktemp("cpp"))


@pytest.fixture
def cpp_server(cpp: CppYarp) -> Iterator[CppYarp]:
    """A fresh C++ name server on 127.0.0.1 and the C++ programs configured for it."""
    with cpp.server() as names:
        yield names


@contextlib.contextmanager
def around_ours(cpp: CppYarp) -> Iterator[CppYarp]:
    """A yarpy name server in this process, and the C++ programs that use it."""
    with (
        yarpy.NameServer(free_block(200)) as server,
        cpp.at("127.0.0.1", server.port) as programs,
        configured_for(programs, by_file=False),
    ):
        yield programs


@contextlib.contextmanager
def around_cpp(cpp: CppYarp) -> Iterator[CppYarp]:
    """A C++ name server, which yarpy finds by the same configuration file as the programs."""
    with cpp.server() as programs, configured_for(programs, by_file=True):
        yield programs


@pytest.fixture(scope="module")
def our_names(cpp: CppYarp) -> Iterator[CppYarp]:
    """C++ programs around a name server of ours."""
    with around_ours(cpp) as programs:
        yield programs


@pytest.fixture(scope="module")
def cpp_names(cpp: CppYarp) -> Iterator[CppYarp]:
    """C++ programs around a C++ name server, and yarpy configured to use it too."""
    with around_cpp(cpp) as programs:
        yield programs


@pytest.fixture(scope="module", params=["yarpy_server", "cpp_server"])
def network(cpp: CppYarp, request: pytest.FixtureRequest) -> Iterator[CppYarp]:
    """C++ programs and yarpy around a name server of either kind."""
    with around_ours(cpp) if request.param == "yarpy_server" else around_cpp(cpp) as programs:
        yield programs


@pytest.fixture
def peer(network: CppYarp) -> Iterator[CppProgram]:
    """A C++ program to talk to, which has opened nothing yet."""
    with CppProgram(network) as program:
        yield program


@pytest.fixture(scope="module")
def side(our_names: CppYarp, request: pytest.FixtureRequest) -> Iterator[CppProgram]:
    """A C++ program with the port `/cpp`."""
    with CppProgram(our_names) as program:
        program.do(request.module.SIDE)
        yield program


@pytest.fixture
def port(side: CppProgram) -> Iterator[yarpy.Port]:
    """A port of ours that sends to `/cpp` and hears it."""
    with yarpy.Port("/ours") as ours:
        ours.connect("/cpp")
        ours.listen_to("/cpp")
        yield ours


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/arm/state", names=names) as port:
        yield port


@pytest.fixture
def reader(names: yarpy.LocalNames) -> Iterator[yarpy.BufferedPort]:
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        yield port
