"""The socket of a running application, and what is remembered for the next one."""

import json
import os
import socket
import subprocess
import sys

import pytest
from support.system import NO_UNIX_SOCKETS
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.console import control
from yarpy.kits.launch.supervise import process
from yarpy.limit import CONTROL_LINE
from yarpy.platform import local_socket


@pytest.fixture
def served(runtime):
    def answer(asked):
        if asked["do"] == "fail":
            raise LocalProtocolError("no such thing")
        return {"got": asked}

    record = control.Record("my app")
    serving = control.Control("my app", answer)
    yield runtime
    serving.close()
    record.close()


def test_questions_and_answers(served) -> None:
    assert control.ask("my app", do="x", name="y") == {"got": {"do": "x", "name": "y"}}
    with pytest.raises(LocalProtocolError, match="no such thing"):
        control.ask("my app", do="fail")
    assert control.running() == ["my_app"]


@pytest.mark.skipif(bool(NO_UNIX_SOCKETS), reason=NO_UNIX_SOCKETS)
def test_nobody_else_may(served) -> None:
    assert served.stat().st_mode & 0o777 == 0o700
    (path,) = served.glob("*.sock")
    assert path.stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("line", [b"\n", b"[]\n", b"{" * 100_000, b"x" * (2 * CONTROL_LINE), b""])
def test_what_is_no_question(served, line: bytes) -> None:
    (path,) = served.glob("*.sock")
    with local_socket.connect(path, HANG) as link:
        try:
            link.sendall(line)
            link.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # it does not read on
        with link.makefile("rb") as file:
            try:
                said = file.readline()
            except ConnectionResetError:
                said = b""
    assert not said or "this is no request" in json.loads(said)["error"]
    assert control.ask("my app", do="x") == {"got": {"do": "x"}}


def test_only_one_of_a_name(served) -> None:
    with pytest.raises(LocalProtocolError, match="`yarpy down my app` ends it"):
        control.Record("my app")


def test_who_is_not_there(served) -> None:
    with pytest.raises(LocalProtocolError, match=r'no application called "other".*"my_app"'):
        control.ask("other", do="status")


@pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
def test_what_a_killed_one_left_is_found(runtime) -> None:
    record = control.Record("a")
    record.write("run-1", ["x", "y"])
    record._file.close()  # as the system does when a process is killed
    child = subprocess.Popen(["sleep", "600"], env={**os.environ, process.MARK: "run-1/y"})
    try:
        again = control.Record("a")
        wait_until(lambda: again.left() == {child.pid: "y"})
    finally:
        child.kill()
        child.wait()
    assert again.left() == {}
    again.close()
    assert control.running() == []


def test_what_may_go_on_at_servers_is_remembered_until_it_ends(runtime) -> None:
    record = control.Record("a")
    record.write("run-1", ["x", "y"], {"a:x": "/node"})
    record.close({"a:x": "/node"})
    again = control.Record("a")
    assert again.away() == {"a:x": "/node"} and again.left() == {}
    again.close()
    last = control.Record("a")
    assert last.away() == {}
    last.close()


@pytest.mark.parametrize(
    "text",
    [
        *("", "[]", '{"run": 1}', '{"run": "x", "programs": 7}'),
        '{"run": "x", "programs": [], "away": 7}',
    ],
)
def test_a_damaged_record_is_none(runtime, text: str) -> None:
    record = control.Record("a")
    (runtime / "a.json").write_text(text)
    assert record.left() == {} and record.away() == {}
    record.close()


def test_an_application_is_reached_from_other_programs(cli) -> None:
    program = [sys.executable, "-c", "import time; print('up', flush=True); time.sleep(600)"]
    path = cli.home / "reached.toml"
    path.write_text(f"[programs.a]\ncommand = {json.dumps(program)}\n")
    with cli.start("up", str(path), "--lines") as up:
        up.wait_line(r"a \| up", timeout=2 * HANG)

        def states() -> list[str]:
            told = json.loads(cli.run("status", "--json").stdout)
            return [one["state"] for one in told["programs"]]

        wait_until(lambda: states() == ["running"])  # it speaks before `up` knows that it has begun
        assert "up" in cli.run("logs").stdout
        assert cli.run("stop", "a").returncode == 0
        up.wait_line(r"\* a stopped")
        assert cli.run("down", "reached").stdout == "reached has stopped\n"
        assert up.wait() == 0
