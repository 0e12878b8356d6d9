"""What a port writes is spelled as its reader spells it, whichever version of YARP that is: 4 has
other floats (`data/yarp4.py`)."""

from __future__ import annotations

from collections.abc import Iterator
from tempfile import TemporaryDirectory

import pytest
from support.cpp import CppYarp
from support.wait import HANG

import yarpy

VALUES = [1, 2.25, "a b", [1.5, 2.5], ["x", 0.5]]
LINE = r'1 2\.25 "a b" \(1\.5 2\.5\) \(x 0\.5\)'


@pytest.fixture
def runtime(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A place for Unix sockets, without which C++ YARP 4 has none. Their paths are short."""
    with TemporaryDirectory(prefix="yarpy-") as directory:
        monkeypatch.setenv("XDG_RUNTIME_DIR", directory)
        yield


@pytest.mark.usefixtures("runtime")
@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "mcast", "text", "unix_stream"])
def test_floats_reach_readers_of_any_version(network: CppYarp, carrier: str) -> None:
    if carrier == "unix_stream" and network.package is not None:
        pytest.skip("yarp of the package loads no carriers: test_table.py meets that one")
    with network.popen("read", "/tool/cpp") as reader, yarpy.Port("/ours") as port:
        yarpy.wait_for("/tool/cpp", timeout=HANG)
        port.connect("/tool/cpp", carrier)
        for _ in range(3):
            port.write(VALUES)
        reader.wait_line(LINE, count=1 if carrier in ("udp", "mcast") else 3, timeout=HANG)
        assert port.outputs, "what cannot be read ends a connection"


def test_floats_of_questions(network: CppYarp) -> None:
    with network.popen("rpcserver", "--echo", "/tool/cpp"), yarpy.RpcClient() as client:
        yarpy.wait_for("/tool/cpp", timeout=HANG)
        client.connect("/tool/cpp")
        assert client.call(*VALUES, timeout=HANG) == VALUES


def test_floats_of_answers_to_floats(network: CppYarp) -> None:
    with yarpy.RpcServer("/ours", lambda message: message.value):
        done = network.run("rpc", "/ours", input="1 2.25 (1.5 2.5)\n")
    assert "Response: 1 2.25 (1.5 2.5)" in done.stdout


def test_floats_of_answers_beside_the_name_server_of_cpp(cpp_server: CppYarp) -> None:
    """The questions do not tell."""
    with (
        yarpy.YarpNameClient("127.0.0.1", cpp_server.port) as names,
        yarpy.RpcServer("/ours", lambda message: [1, 2.25, [1.5, 2.5]], names=names),
    ):
        done = cpp_server.run("rpc", "/ours", input="which\nwhich\n")
    assert done.stdout.count("Response: 1 2.25 (1.5 2.5)") == 2
