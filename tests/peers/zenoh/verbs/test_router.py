"""`yarpy router`, and the commands for names that need no server."""

import json
import signal

import pytest
from support.command_line import CommandLine
from support.port import free_port

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


def test_names_and_connections_without_a_server(lone: CommandLine) -> None:
    where = f"tcp/127.0.0.1:{free_port()}"
    lone.environment |= {"YARPY_SERVER": "zenoh", "YARPY_ZENOH": where}
    said = lone.run_alone("where")
    assert said.returncode == 1 and "start one with `yarpy router`" in said.stdout
    with lone.start("router", where) as router:
        router.wait_line(f"Zenoh router at {where}")
        with lone.start("read", "/in") as reader:
            assert lone.run_alone("wait", "/in", "--timeout", "10").returncode == 0
            with lone.start("rpcserver", "/answers"):
                assert lone.run_alone("wait", "/answers", "--timeout", "10").returncode == 0
                listed = lone.run_alone("name", "list").stdout.splitlines()
                assert [line.split()[2] for line in listed[:-1]] == ["/answers", "/in"]
            found = json.loads(lone.run_alone("name", "query", "/in", "--json").stdout)
            assert found["name"] == "/in" and found["carrier"] == "tcp"
            assert "property process = " in lone.run_alone("name", "get", "/in", "process").stdout
            said = lone.run_alone("name", "register", "/x", "tcp", "127.0.0.1", "1")
            assert said.returncode == 1 and "there is no server" in said.stderr
            lone.run_alone("write", "/out", "/in", input="1 2 (a b)\n")
            reader.wait_line(r"1 2 \(a b\)")
        said = lone.run_alone("where")
        assert (said.returncode, said.stdout) == (
            0,
            f"Names of /root: names on Zenoh, at {where}\nThere is no name server of YARP there.\n",
        )
        twice = lone.run_alone("router", where)
        assert twice.returncode == 1 and "another address" in twice.stderr
        router.signal(signal.SIGTERM)
        assert router.wait() == 0


def test_another_router_that_does_not_answer_is_named(lone: CommandLine) -> None:
    here, there = (f"tcp/127.0.0.1:{free_port()}" for _ in range(2))
    with lone.start("router", here, "--connect", there) as router:
        router.wait_line(f"Zenoh router at {here}, joins {there}")
        router.wait_line(f"not joined with {there} yet: Connection refused", stream="err")
        with lone.start("router", there, "--connect", here) as other:
            other.wait_line("Zenoh router at")
            lone.environment |= {"YARPY_SERVER": "zenoh", "YARPY_ZENOH": there}
            assert lone.run_alone("name", "list").returncode == 0
            other.signal(signal.SIGTERM)
            assert other.wait() == 0
