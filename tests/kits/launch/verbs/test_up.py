"""`yarpy up`: from the file to the last process."""

import json
import os
import signal
import subprocess
import sys

import pytest
from support.wait import HANG, wait_until

from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")

YARPY = f"{sys.executable} -m yarpy"


def write(cli, text: str, name: str = "app.toml") -> str:
    path = cli.home / name
    path.write_text(text)
    return str(path)


def status(cli) -> dict:
    return json.loads(cli.run("status", "--json").stdout)


def alive(pid: int) -> bool:
    found = process.look(pid)
    return found is not None and found.alive


def test_programs_and_connections_until_an_interrupt(cli) -> None:
    path = write(
        cli,
        f"""
connections = ["/up/talker -> /up/listener"]
[programs.listener]
command = "{YARPY} read /up/listener"
[programs.talker]
command = ["sh", "-c", "while echo hello; do sleep 0.1; done | {YARPY} write /up/talker"]
needs = ["/up/listener"]
""",
    )
    with cli.start("up", path) as up:
        up.wait_line(r"listener \| hello")
        # It may come before `up` knows that what it has made is there.
        wait_until(lambda: {one["state"] for one in status(cli)["connections"]} == {"connected"})
        told = status(cli)
        assert [one["state"] for one in told["programs"]] == ["running"] * 2
        os.kill(told["programs"][0]["pid"], signal.SIGKILL)
        up.wait_line(r"\* listener pausing: killed by SIGKILL; again in 0.1 s")
        up.wait_line(r"\* listener running", count=2)
        up.wait_line(r"listener \| hello", count=up.stdout.count("listener | hello") + 1)
        pids = [one["pid"] for one in status(cli)["programs"]]
        up.signal(signal.SIGINT)
        assert up.wait() == 0
    assert not any(map(alive, pids))
    ends = [line for line in up.stdout.splitlines() if line.endswith(" stopping")]
    assert ends == ["* talker stopping", "* listener stopping"]


def test_the_same_of_xml(cli) -> None:
    path = write(
        cli,
        f"""<application><name>xml app</name>
<module><name>{sys.executable}</name><parameters>-m yarpy read /up/xml</parameters></module>
<module><name>sleep</name><parameters>600</parameters><node>localhost</node>
<dependencies><port timeout="60">/up/xml</port></dependencies></module>
</application>""",
        "app.xml",
    )
    with cli.start("up", path) as up:
        up.wait_line(r"\* sleep running")
        assert status(cli)["application"] == "xml_app"
        assert cli.run("down", "xml_app").stdout == "xml_app has stopped\n"
        assert up.wait() == 0


def test_what_fails_is_told_by_the_exit_code(cli) -> None:
    path = write(
        cli,
        """
[programs.good]
command = "true"
[programs.bad]
command = "false"
restart = "no"
[programs.none]
command = "/no/such/program"
""",
    )
    done = cli.run("up", path)
    assert done.returncode == 1
    assert "error: bad: ended with 1" in done.stderr and "error: none: it cannot" in done.stderr
    assert "good" not in done.stderr


def test_one_failure_may_end_all(cli) -> None:
    path = write(cli, "[programs]\na = 'sleep 600'\nb = 'false'\n")
    done = cli.run("up", path, "--stop-on-failure", "--restart", "no")
    assert done.returncode == 1 and "* a stopped" in done.stdout


def test_check(cli) -> None:
    path = write(cli, "nmae = 'x'\n[programs]\na = 'no-such-program'\n")
    done = cli.run("up", path, "--check")
    assert done.returncode == 1
    first, second, last = done.stdout.splitlines()
    assert first == f'{path}:1:1: warning: "nmae" is ignored: did you mean "name"?'
    assert 'error: "a": there is no program "no-such-program" on the PATH' in second
    assert last == "app: 1 program, 0 connections, 2 problems"
    fine = write(cli, "[programs]\na = 'sleep 1'\n", "fine.toml")
    done = cli.run("up", fine, "--check")
    assert (done.returncode, done.stdout) == (0, "fine: 1 program, 0 connections, no problems\n")


def test_a_file_with_errors_starts_nothing(cli) -> None:
    path = write(cli, "[programs.a]\ncommand = 'sleep 600'\nafter = ['b']\n")
    done = cli.run("up", path)
    assert done.returncode == 1 and done.stdout == ""
    assert 'app.toml:1:1: "b", after which it starts, is no program' in done.stderr
    assert cli.run("up", write(cli, "", "empty.toml")).returncode == 1


def test_a_killed_one_is_found_out_about(cli) -> None:
    path = write(cli, "[programs]\na = 'sleep 600'\n")
    with cli.start("up", path) as up:
        up.wait_line(r"\* a running")
        with cli.start("up", path) as other:
            assert other.wait() == 1 and '"app" is running already' in other.stderr
        (told,) = status(cli)["programs"]
        up.signal(signal.SIGKILL)
        up.wait()
        assert alive(told["pid"])
        done = cli.run("up", path)
        assert done.returncode == 1
        assert f"are still there: a (pid {told['pid']})" in done.stderr
        with cli.start("up", path, "--replace") as again:
            again.wait_line(r"\* a running")
            wait_until(lambda: not alive(told["pid"]))
            (new,) = status(cli)["programs"]
            again.signal(signal.SIGKILL)
            again.wait()
        assert (
            cli.run("down", "app").stdout == f"ended what was left of app: a (pid {new['pid']})\n"
        )
        assert not alive(new["pid"])


def test_a_second_interrupt_kills(cli) -> None:
    deaf = "trap '' TERM; echo ready; while :; do sleep 0.05; done"
    path = write(cli, f'[programs.deaf]\ncommand = ["sh", "-c", "{deaf}"]\n')
    with cli.start("up", path, "--grace", "600") as up:
        up.wait_line(r"deaf \| ready")
        up.wait_line(r"\* deaf running")
        (told,) = status(cli)["programs"]
        up.signal(signal.SIGINT)
        up.wait_line(r"\* deaf stopping")
        up.signal(signal.SIGINT)
        up.wait()
        assert not alive(told["pid"])


def test_programs_at_a_server_that_stands_still_for_a_while(cli) -> None:
    path = write(
        cli, '[programs.far]\ncommand = ["sh", "-c", "echo hello; sleep 600"]\nnode = "/up/node"\n'
    )
    with cli.start("run", "--server", "/up/node", "--end-programs") as node:
        node.wait_line("/up/node starts programs")
        with cli.start("up", path) as up:
            up.wait_line(r"far \| hello")
            up.wait_line(r"\* far running")  # it speaks before `up` knows that it has begun
            (told,) = status(cli)["programs"]
            assert told["host"] == "/up/node" and told["state"] == "running"
            node.signal(signal.SIGSTOP)
            wait_until(lambda: status(cli)["programs"][0]["state"] == "unknown")
            node.signal(signal.SIGCONT)
            wait_until(lambda: status(cli)["programs"][0]["state"] == "running")
            up.signal(signal.SIGINT)
            assert up.wait() == 0
        assert not alive(told["pid"])


def test_the_end_of_its_terminal_is_that_of_all(cli) -> None:
    path = write(cli, 'name = "closed"\n[programs]\nnap = "sleep 1000"')
    ours, theirs = os.openpty()
    heard = (
        "import signal; signal.signal(1, signal.SIG_DFL); from yarpy.cli.start import main; main()"
    )
    command = [sys.executable, "-c", heard, "up", path]
    with subprocess.Popen(
        command, stdin=theirs, stdout=theirs, stderr=theirs, cwd=cli.home, env=cli.environment
    ) as up:
        try:
            os.close(theirs)
            shown = b""
            while b"running" not in shown:
                shown += os.read(ours, 4096)
            (pid,) = [one["pid"] for one in status(cli)["programs"]]
            os.close(ours)
            for _ in range(2):  # one from the shell, one from the system
                up.send_signal(signal.SIGHUP)
            up.wait(HANG)
        finally:
            up.kill()
    assert not alive(pid)
