"""The C++ side of the interoperation tests.

`cpp` is a real C++ YARP without a name server, for the session; `cpp_server` adds a C++ name server
of its own to each test. Both skip with the reason where C++ YARP cannot be had.
"""

from collections.abc import Iterator

import pytest
from support.cpp import CppYarp, MissingPeer


@pytest.fixture(scope="session")
def cpp(tmp_path_factory: pytest.TempPathFactory) -> CppYarp:
    """C++ YARP 3.5: `cpp.server()`, `cpp.at(host, port)`, then run, popen, python on the result."""
    try:
        return CppYarp.prepare(tmp_path_factory.mktemp("cpp"))
    except MissingPeer as missing:
        pytest.skip(str(missing))


@pytest.fixture
def cpp_server(cpp: CppYarp) -> Iterator[CppYarp]:
    """A fresh C++ name server on 127.0.0.1 and the C++ programs configured for it."""
    with cpp.server() as names:
        yield names
