"""`yarpy server` as the name server of C++ programs: commands, databases, discovery, killing it."""

import contextlib
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.port import free_block
from support.process import Process
from support.wait import HANG, wait_until

import yarpy


@contextlib.contextmanager
def serving(programs: CppYarp, *options: str) -> Iterator[Process]:
    """`yarpy server` where `programs` look for theirs; it answers."""
    command = [sys.executable, "-m", "yarpy", "server", "--read", *options]
    with Process(command, env=programs.environment, cwd=programs.home) as process:
        process.wait_line("Ready!", timeout=HANG)
        yield process


@pytest.fixture
def programs(cpp: CppYarp) -> Iterator[CppYarp]:
    """C++ programs, and yarpy in this process, configured for a server that does not run yet."""
    with cpp.at("127.0.0.1", free_block(200)) as programs, configured_for(programs, by_file=True):
        yield programs


def test_the_name_tool(programs: CppYarp) -> None:
    with serving(programs):
        number = programs.port + 2

        def ask(*words: str) -> str:
            return programs.run("name", *words).stdout

        registered = f"registration name /x ip 127.0.0.1 port {number} type tcp\n"
        assert ask("register", "/x") == registered + "\n"
        assert ask("query", "/x") == registered + "\n"
        assert ask("register", "/y", "udp", "10.0.0.1", "5") == (
            "registration name /y ip 10.0.0.1 port 5 type udp\n\n"
        )
        assert programs.run("name", "query", "/nope").returncode == 1
        end = "*** end of message\n"
        assert ask("set", "/x", "colour", "blue", "5") == f"port /x property colour = 5 blue\n{end}"
        assert ask("get", "/x", "colour") == f"port /x property colour = 5 blue\n{end}"
        assert ask("check", "/x", "colour", "5") == (
            f"port /x property colour value 5 present true\n{end}"
        )
        assert ask("list", "/y") == f"registration name /y ip 10.0.0.1 port 5 type udp\n{end}"
        assert ask("unregister", "/y") == "Unregistered name.\n"
        assert ask("list") == (
            f"registration name /root ip 127.0.0.1 port {programs.port} type tcp\n"
            f"registration name /x ip 127.0.0.1 port {number} type tcp\n"
            f"registration name fallback ip 224.2.1.1 port {programs.port} type mcast\n{end}"
        )
        found = programs.run("where")
        assert found.returncode == 0
        assert f"/root is available at ip 127.0.0.1 port {programs.port}\n" in found.stdout


def test_detect_by_multicast(programs: CppYarp) -> None:
    with serving(programs):
        (programs.home / "config/yarp.conf").unlink()
        found = programs.run("detect", "--write")
        assert found.returncode == 0, found.stdout + found.stderr
        assert (programs.home / "config/yarp.conf").read_text().split()[:2] == [
            "127.0.0.1",
            str(programs.port),
        ]


def test_what_the_server_prints(programs: CppYarp) -> None:
    with serving(programs, "--verbose") as server:
        programs.run("exists", "/somebody")
        server.wait_line('query "/somebody"')
        server.signal(signal.SIGTERM)
        assert server.wait() == 0
        assert "Traceback" not in server.stderr


def written(home: Path) -> bool:
    """Whether the port and the rule are in the files, for good."""
    ports, rules = ((home / name).read_bytes() for name in ("ports.db", "subscriptions.db"))
    return b"/cpp" in ports and b"/ours" in rules and not [*home.glob("*.db-journal")]


def test_a_database_outlives_the_server(programs: CppYarp) -> None:
    """C++ ports do not register again by themselves: the server has to remember them."""
    databases = ("--portdb", "ports.db", "--subdb", "subscriptions.db")
    with CppProgram(programs) as peer:
        with serving(programs, *databases) as server:
            peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp'); port.setStrict()")
            assert programs.run("connect", "--persist", "/ours", "/cpp").returncode == 0
            wait_until(lambda: written(programs.home), what="what changed is written")
            server.kill()
        with serving(programs, *databases):
            assert programs.run("exists", "/cpp").returncode == 0
            with yarpy.Port("/ours") as port:
                assert port.wait_for_outputs(timeout=HANG), "the persistent connection is known"
                port.write(["hello"])
                assert peer.do("port.read().toString()") == "hello"


def test_streams_go_on_without_the_server(programs: CppYarp) -> None:
    """What is connected stays so; our names come back with the server, and connections work."""
    with CppProgram(programs) as peer:
        with serving(programs) as server:
            peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp'); port.setStrict()")
            port = yarpy.Port("/ours")
            port.connect("/cpp")
            port.write([1])
            assert peer.do("port.read().toString()") == "1"
            server.kill()
            port.write([2])
            assert peer.do("port.read().toString()") == "2"
        with serving(programs), port:
            wait_until(
                lambda: programs.run("exists", "/ours").returncode == 0, what="/ours is back"
            )
            port.write([3])
            assert peer.do("port.read().toString()") == "3"
            peer.do("late = yarp.Port(); assert late.open('/late')")
            assert peer.do("yarp.Network.connect('/late', '/ours')")
            peer.begin("late.write(yarp.Bottle('4'))")
            assert port.read(timeout=HANG).value == [4]
            assert peer.end()
        assert programs.run("exists", "/ours").returncode == 1
