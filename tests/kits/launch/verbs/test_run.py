"""`yarpy run`, as people type it: a server, what it starts, and a terminal."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.process import Process
from support.wait import wait_until

from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")


@pytest.fixture
def shell(cli: CommandLine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> CommandLine:
    monkeypatch.setitem(cli.environment, "XDG_STATE_HOME", str(tmp_path))
    return cli


@pytest.fixture
def node(shell: CommandLine) -> Iterator[Process]:
    with shell.start("run", "--server", "/nodeA", "--end-programs") as server:
        server.wait_line("/nodeA starts programs for its user on this computer")
        yield server
        server.signal(signal.SIGTERM)
        assert server.wait() == 0


def test_a_program_from_its_start_to_its_end(node: Process, shell: CommandLine) -> None:
    on = ("run", "--on", "/nodeA")
    said = shell.run(*on, "--as", "s", "--env", "FOO=bar", "--", "sh", "-c", "echo $FOO; sleep 60")
    assert said.returncode == 0 and said.stdout.startswith("STARTED: server=/nodeA alias=s")
    assert "sh -c" in shell.run(*on, "--ps").stdout
    row = json.loads(shell.run(*on, "--ps", "--json").stdout)
    assert row["tag"] == "s" and row["env"] == "FOO=bar"
    wait_until(lambda: shell.run(*on, "--output", "s").stdout == "bar\n")
    assert shell.run(*on, "--isrunning", "s").stdout == "running\n"
    assert shell.run(*on, "--sigterm", "s").returncode == 0
    wait_until(lambda: shell.run(*on, "--isrunning", "s").returncode == 2)
    gone = shell.run(*on, "--kill", "s", "9")
    assert gone.returncode == 2 and "nothing runs as s" in gone.stderr


def test_what_is_not_done_is_told(node: Process, shell: CommandLine) -> None:
    said = shell.run("run", "--on", "/nodeA", "--cmd", "nosuch 1")
    assert said.returncode == 2 and "no program nosuch" in said.stderr
    assert shell.run("run", "--on", "/nobody", "--ps").returncode == 1
    for words in (["--ps"], ["--on", "", "--ps"], ["--server", ""]):
        assert "--on /NAME" in shell.run("run", *words).stderr
    assert "say what" in shell.run("run", "--on", "/nodeA").stderr


def test_a_terminal(node: Process, shell: CommandLine) -> None:
    words = ("run", "--on", "/nodeA", "--as", "sh", "--stdio", ".", "--", "sh")
    with shell.start(*words) as terminal:
        terminal.wait_line("STARTED")
        terminal.write_line("echo $((40 + 2))")
        terminal.wait_line("^42$")
        terminal.write_line("exit")
        assert terminal.wait() == 0


def test_a_server_that_is_killed_and_comes_back(shell: CommandLine) -> None:
    with shell.start("run", "--server", "/nodeB") as server:
        server.wait_line("starts programs")
        said = shell.run("run", "--on", "/nodeB", "--as", "a", "--cmd", "sleep 600")
        assert said.returncode == 0
        os.kill(server.pid, signal.SIGKILL)
        server.wait()
    with shell.start("run", "--server", "/nodeB", "--end-programs") as server:
        pid = int(server.wait_line(r"a still runs as process (\d+)")[1])
        assert shell.run("run", "--on", "/nodeB", "--exit").returncode == 0
        assert server.wait() == 0
    wait_until(lambda: process.look(pid) is None or not process.look(pid).alive)


def test_a_server_that_ends_says_what_goes_on(shell: CommandLine) -> None:
    with shell.start("run", "--server", "/nodeC", "--allow", "sleep") as server:
        server.wait_line("starts sleep for its user")
        shell.run("run", "--on", "/nodeC", "--as", "a", "--cmd", "sleep 600")
        refused = shell.run("run", "--on", "/nodeC", "--cmd", "true")
        assert refused.returncode == 2 and '--allow "true"' in refused.stderr
        server.signal(signal.SIGINT)
        pid = int(server.wait_line(r"a goes on as process (\d+)")[1])
        assert server.wait() == 0
    os.kill(pid, signal.SIGKILL)
