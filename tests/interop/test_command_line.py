"""`yarpy VERB` and C++ `yarp VERB` as one set of tools, around a name server of either kind."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.cpp import CppYarp
from support.port import free_port
from support.wait import wait_until


@pytest.fixture(scope="module")
def cli(network: CppYarp, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CommandLine]:
    yield CommandLine(
        tmp_path_factory.mktemp("home"),
        {"YARPY_SERVER": f"{network.host}:{network.port}", "YARP_PORT_RANGE": str(network.port)},
    )


TEXT = '1 ping 3.14\n(a (1 2)) [set] "two words"\n\nlast\n'
LINES = ["1 ping 3.14000000000000012434", '(a (1 2)) [set] "two words"', "", "last"]


def data(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.startswith("[INFO]")]


def test_write_to_a_cpp_reader(network: CppYarp, cli: CommandLine) -> None:
    with network.popen("read", "/tool/cpp") as reader:
        assert cli.run("wait", "/tool/cpp").returncode == 0
        assert cli.run("write", "/tool/w", "/tool/cpp", input=TEXT).returncode == 0
        reader.wait_line("^last$", stream="out")
        assert data(reader.stdout) == LINES
        assert cli.run("write", "/tool/w", "verbatim", "/tool/cpp", input="a (b").returncode == 0
        assert reader.wait() == 0  # the end of verbatim lines ends it
        assert data(reader.stdout) == [*LINES, "a (b"]


def test_read_from_a_cpp_writer(network: CppYarp, cli: CommandLine) -> None:
    with cli.start("read", "/tool/ours") as reader:
        reader.wait_line("active", stream="err")
        assert network.run("write", "/tool/w", "/tool/ours", input=TEXT).returncode == 0
        reader.wait_line("^last$", stream="out")
        words = ("write", "/tool/w", "verbatim", "/tool/ours")
        assert network.run(*words, input="a (b\n").returncode == 0
        assert reader.wait() == 0
    assert reader.stdout.splitlines() == [*LINES, "a (b"]


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "text_ack"])
def test_connect_what_is_theirs_and_ours(network: CppYarp, cli: CommandLine, carrier: str) -> None:
    with cli.start("read", "/tool/r") as reader, network.popen("write", "/tool/w") as writer:
        assert cli.run("wait", "/tool/r").returncode == 0
        assert cli.run("wait", "/tool/w").returncode == 0
        said = cli.run("connect", "/tool/w", "/tool/r", carrier)
        line = f"Success: Added connection from /tool/w to {carrier}://tool/r\n"
        assert (said.returncode, said.stdout, said.stderr) == (0, line, "")
        assert cli.run("exists", "/tool/w", "/tool/r").returncode == 0
        for tool in (cli, network):
            assert f'output connection from "/tool/w" to "/tool/r" using {carrier}' in (
                tool.run("ping", "/tool/w").stdout
            )
        writer.write_line("through")
        reader.wait_line("^through$", stream="out")
        assert cli.run("disconnect", "/tool/w", "/tool/r").returncode == 0
        assert cli.run("exists", "/tool/w", "/tool/r").returncode == 1


def test_rpc_both_ways(network: CppYarp, cli: CommandLine) -> None:
    with (
        network.popen("rpcserver", "--echo", "/tool/cpp:rpc"),
        cli.start("rpcserver", "--echo", "/tool/ours:rpc"),
    ):
        for name, tool in (("/tool/cpp:rpc", cli), ("/tool/ours:rpc", network)):
            assert cli.run("wait", name).returncode == 0
            said = tool.run("rpc", name, input="a (b 1.5)\n[x]\n")
            assert (said.returncode, said.stdout) == (
                0,
                "Response: a (b 1.5)\nResponse: [x]\n",
            )
            wait_until(partial(_tells_its_inputs, tool, name))


def _tells_its_inputs(tool: CppYarp | CommandLine, name: str) -> bool:
    """Return whether the port says that nobody but this question comes to it. One of C++ lists for
    a moment who has asked it something just before."""
    said = tool.run("admin", "rpc", name, input="[ver]\n[list] [in]\n")
    return said.stdout == "Response: [ver] 1 2 3\nResponse: anon_rpc\n"


def test_what_both_tools_say_of_the_server(network: CppYarp, cli: CommandLine) -> None:
    assert cli.run("name", "list").stdout == network.run("name", "list").stdout
    assert cli.run("name", "help").stdout == network.run("name", "help").stdout
    assert cli.run("topic", "/tool/topic").stdout == network.run("topic", "/tool/topic").stdout
    assert cli.run("topic", "--list").stdout == network.run("topic", "--list").stdout
    assert cli.run("connect", "--persist", "/tool/a", "/tool/b", "udp").returncode == 0
    assert "Persistent connection /tool/a -> udp://tool/b" in network.run("connect").stdout
    assert cli.run("disconnect", "--persist", "/tool/a", "/tool/b").returncode == 0
    assert cli.run("connect").stdout == "No persistent connections.\n"


def test_clean_leaves_the_living(network: CppYarp, cli: CommandLine) -> None:
    cli.run("name", "register", "/tool/dead", "tcp", "127.0.0.1", "1")
    with network.popen("read", "/tool/cpp"):
        assert cli.run("wait", "/tool/cpp").returncode == 0
        said = cli.run("clean", "--timeout", "10")
        assert "* No response, removing port /tool/dead\n" in said.stdout
        assert said.stdout.count("removing") == 1
        assert cli.run("exists", "/tool/cpp").returncode == 0


def test_stats_of_a_cpp_port(network: CppYarp, cli: CommandLine) -> None:
    with network.popen("write", "/tool/w") as writer:
        assert cli.run("wait", "/tool/w").returncode == 0
        with cli.start("stats", "/tool/w", "--duration", "5") as stats:
            stats.wait_line("btl/s", stream="out")  # earlier the writer may not have the output
            for _ in range(10):
                writer.write_line("x")
            assert stats.wait() == 0
        assert ",  10 total bottles received," in stats.stdout


def test_a_server_of_ours_for_cpp_programs(cpp: CppYarp, tmp_path: Path) -> None:
    """`yarpy server` writes the file that C++ programs read."""
    port = free_port()
    ours = CommandLine(tmp_path, {"YARP_PORT_RANGE": str(port)})
    with ours.start("server", "--ip", "127.0.0.1", "--socket", str(port)) as server:
        server.wait_line("Ready", stream="out")
        theirs = CppYarp(cpp.root, tmp_path, "127.0.0.1", port)
        assert (tmp_path / "config" / "yarp.conf").exists()
        said = theirs.run("where")
        assert f"Name server /root is available at ip 127.0.0.1 port {port}\n" in said.stdout
        assert "*** YARP seems okay!" in theirs.run("check").stdout
        said = theirs.run("name", "register", "/tool/cam", "mjpeg", "10.0.0.5", "80")
        assert said.stdout == "registration name /tool/cam ip 10.0.0.5 port 80 type mjpeg\n\n"
        server.wait_line(r'^ \* register "/tool/cam" mjpeg "10.0.0.5" 80$', stream="out")
        server.wait_line(r'^   \+ set "/tool/cam" offers ', stream="out")
