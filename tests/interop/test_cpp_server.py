"""yarpy ports at the C++ name server: registering, asking, closing, and the server's death."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.lasted import lasted
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy import Contact


def listing(programs: CppYarp) -> str:
    return programs.run("name", "list").stdout


def test_registration(cpp_names: CppYarp) -> None:
    with yarpy.Port("/ours", port_type="yarp/image") as port:
        host, _, number = port.address.partition(":")
        line = f"registration name /ours ip {host} port {number} type tcp\n"
        assert line in listing(cpp_names)
        assert yarpy.query("/ours") == Contact("tcp", "/ours", host, int(number))
        assert cpp_names.run("name", "get", "/ours", "type").stdout.startswith(
            "port /ours property type = yarp/image\n"
        )
        offers = cpp_names.run("name", "get", "/ours", "offers").stdout
        assert "tcp" in offers.split() and "mcast" in offers.split()
        # The name is ours as long as we live; C++ would take it away in silence.
        with pytest.raises(yarpy.AddressError, match="is in use by this program"):
            yarpy.Port("/ours")
    assert yarpy.query("/ours") is None
    assert line not in listing(cpp_names)


def test_names_that_the_server_makes(cpp_names: CppYarp) -> None:
    with yarpy.Port("...") as first, yarpy.Port("...") as second:
        assert first.name != second.name
        for port in (first, second):
            assert port.name.startswith("/tmp/port/")
            assert cpp_names.run("exists", port.name).returncode == 0


def test_a_number_of_ones_own(cpp_names: CppYarp) -> None:
    number = free_port()
    with yarpy.Port("/mine", tcp_port=number) as port:
        assert port.contact.port == number
        assert cpp_names.run("exists", "/mine").returncode == 0


def test_the_multicast_group_is_given_back(cpp_names: CppYarp) -> None:
    with yarpy.Port("/source") as source, yarpy.BufferedPort("/sink") as sink:
        source.connect("/sink", "mcast")
        assert sink.wait_for_inputs(timeout=HANG)
        assert " type mcast\n" in listing(cpp_names).replace(_fallback(cpp_names), "")
    assert " type mcast\n" not in listing(cpp_names).replace(_fallback(cpp_names), "")


def _fallback(programs: CppYarp) -> str:
    return f"registration name fallback ip 224.2.1.1 port {programs.port} type mcast\n"


def test_a_server_that_was_configured_by_variable(
    cpp_names: CppYarp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """YARPY_SERVER goes before the file."""
    monkeypatch.setenv("YARP_CONFIG_HOME", "/nonexistent")
    with pytest.raises(yarpy.NoNameServer):
        yarpy.Port("/ours")
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{cpp_names.port}")
    with yarpy.Port("/ours"):
        assert cpp_names.run("exists", "/ours").returncode == 0


def test_the_nearest_name_is_named(cpp_names: CppYarp) -> None:
    with yarpy.Port("/camera/left"), yarpy.Port("/ours") as port:
        with pytest.raises(yarpy.UnknownName, match='did you mean "/camera/left"'):
            port.connect("/camera/lfet")
        with pytest.raises(yarpy.UnknownName, match='did you mean "/camera/left"'):
            yarpy.connect("/ours", "/camera/lef")


# --- the death of the server


@pytest.fixture
def server(cpp: CppYarp) -> Iterator[CppYarp]:
    """A C++ server to be killed."""
    with cpp.server() as programs, configured_for(programs, by_file=True):
        yield programs


def test_ports_register_again(cpp: CppYarp, server: CppYarp) -> None:
    """A new server that knows nothing: our ports tell it all, nobody has to do anything."""
    assert server.server_process is not None
    with yarpy.Port("/a", port_type="yarp/vector") as a, yarpy.RpcServer("/b", lambda m: m.value):
        reader = yarpy.BufferedPort("/c", strict=True)
        a.connect("/c")
        addresses = {name: yarpy.query(name) for name in ("/a", "/b", "/c")}
        for turn in range(2):
            server.server_process.kill()
            a.write([turn])
            assert reader.read(timeout=HANG).value == [turn], "a stream does not need the server"
            with cpp.server(port=server.port) as again:
                for name, address in addresses.items():
                    wait_until(lambda: yarpy.query(name) == address, what=name)  # noqa: B023
                assert again.run("exists", "/a").returncode == 0
                wait_until(lambda: "yarp/vector" in again.run("name", "get", "/a", "type").stdout)
                answer = again.run("rpc", "/b", input="x y\n")
                assert answer.stdout == "Response: x y\n"
                with CppProgram(again) as peer:
                    # A C++ server that forgot all lends numbers that living ports have.
                    peer.do(
                        "port = yarp.Port()\n"
                        "names = (f'/cpp{i}' for i in range(9))\n"
                        "name = next(name for name in names if port.open(name))"
                    )
                    assert peer.do("yarp.Network.connect(name, '/c')")
                    peer.do("port.write(yarp.Bottle('hello'))")
                    assert reader.read(timeout=HANG).value == ["hello"]
        with cpp.server(port=server.port) as again:
            wait_until(lambda: yarpy.query("/c") is not None, what="/c is registered")
            reader.close()
            assert yarpy.query("/c") is None


def test_closing_without_a_server(server: CppYarp) -> None:
    """A port can be closed when there is nobody to give its name back to, and soon."""
    port = yarpy.Port("/ours")
    assert server.server_process is not None
    server.server_process.kill()
    began = time.monotonic()
    port.close()
    assert lasted(began) < 2
    with pytest.raises(yarpy.NoNameServer):
        yarpy.Port("/ours")


def test_what_answers_in_text_is_told_from_a_port(cpp_names: CppYarp) -> None:
    """C++'s own `yarp rpc /root` tries three times and says nothing that helps."""
    host, port = yarpy.query("/root").host, yarpy.query("/root").port
    said = subprocess.run(
        [sys.executable, "-m", "yarpy", "rpc", "/root"],
        input="list\n",
        capture_output=True,
        text=True,
        timeout=HANG,
        env={**os.environ, "YARPY_SERVER": f"{host}:{port}"},
    )
    assert said.returncode == 1
    assert said.stderr.startswith('error: "/root" does not answer as a port does (')
    assert "yarpy name list" in said.stderr
