"""Lines from pipes, and from a person at a terminal."""

import os
import re
import select
import subprocess
import sys
import time

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.prompt import Completer, history_file

pty = pytest.importorskip("pty")

CONTROL = re.compile(rb"\x1b\[[0-9;?]*[A-Za-z]|\x07")

PRINT = """
import sys
from yarpy.cli import prompt
for line in prompt.lines(history="test /prompt", complete=lambda: ["home", "hover", "stop"]):
    print(repr(line), flush=True)
"""


# Makes its standard input the terminal that ^C is typed at, then becomes the command.
AT_TERMINAL = (
    "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0);"
    "os.execvp(sys.argv[1], sys.argv[1:])"
)


class Terminal:
    """A program at a terminal, and a person in front of it."""

    def __init__(self, command, env):
        self._fd, end = pty.openpty()
        self._process = subprocess.Popen(
            [sys.executable, "-c", AT_TERMINAL, *command],
            env={**env, "TERM": "dumb"},
            stdin=end,
            stdout=end,
            stderr=end,
            start_new_session=True,
        )
        os.close(end)
        self.said = b""

    def type(self, text):
        os.write(self._fd, text.encode())

    def wait(self, text, timeout=HANG):
        """Wait until `text` was said behind what was waited for before."""
        deadline = time.monotonic() + timeout
        while text.encode() not in CONTROL.sub(b"", self.said):
            ready, _, _ = select.select([self._fd], [], [], max(0, deadline - time.monotonic()))
            assert ready, f"did not say {text!r}: {self.said!r}"
            try:
                data = os.read(self._fd, 4096)
            except OSError:
                data = b""
            assert data, f"ended without saying {text!r}: {self.said!r}"
            self.said += data
        self.said = CONTROL.sub(b"", self.said).partition(text.encode())[2]

    def end(self):
        """The exit code, once the program has ended by itself."""
        return self._process.wait(HANG)

    def __enter__(self):
        return self

    def __exit__(self, *details):
        self._process.kill()
        self._process.wait(HANG)
        os.close(self._fd)


@pytest.fixture
def env(cli, tmp_path):
    return {**cli.environment, "YARP_DATA_HOME": str(tmp_path)}


def session(env):
    return Terminal([sys.executable, "-c", PRINT], env)


def test_prompt_history_and_completion(env, tmp_path):
    pytest.importorskip("readline")
    with session(env) as terminal:
        terminal.wait(">>")
        terminal.type("one line\n")
        terminal.wait("'one line'")
        terminal.wait(">>")
        terminal.type("st\t\n")
        terminal.wait("'stop '")
        terminal.wait(">>")
        terminal.type("\x04")
        assert terminal.end() == 0
    assert (tmp_path / "history" / "test__prompt").read_text() == "one line\nstop \n"

    with session(env) as terminal:
        terminal.wait(">>")
        terminal.type("\x1b[A\x1b[A\n")  # up, up
        terminal.wait("'one line'")
        terminal.wait(">>")
        terminal.type("x\x01y\n")  # to the beginning of the line
        terminal.wait("'yx'")
        terminal.wait(">>")
        terminal.type("\x04")
        assert terminal.end() == 0


def test_history_that_cannot_be_written_is_no_error(env, tmp_path):
    (tmp_path / "history").write_text("a file where a directory should be")
    with session(env) as terminal:
        terminal.wait(">>")
        terminal.type("x\n")
        terminal.wait("'x'")
        terminal.wait(">>")
        terminal.type("\x04")
        assert terminal.end() == 0


def test_rpc_at_a_terminal(cli, names):
    """A prompt, and the words of the server behind Tab; ^C ends it quietly."""

    def answer(message):
        if message.value == ["help"]:
            return [yarpy.Vocab("many"), "*** Available commands:", "home", "stop"]
        return message.value

    command = [sys.executable, "-m", "yarpy", "rpc", "/prompt/server"]
    with (
        yarpy.RpcServer("/prompt/server", answer, names=names),
        Terminal(command, cli.environment) as terminal,
    ):
        terminal.wait(">>")
        terminal.type("ho\tnow\n")
        terminal.wait("Response: home now")
        terminal.wait(">>")
        time.sleep(0.2)  # Python's prompt overlooks a signal in its first microseconds
        terminal.type("\x03")
        assert terminal.end() == 130
        assert b"Traceback" not in terminal.said


def test_pipes_have_no_prompt(cli):
    with cli.start("rpcserver", "--echo", "/prompt/none") as process:
        process.write_line("x")
        process.wait_line("Waiting")
    assert process.stdout == "Waiting for a message...\n"


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("", []),
        ("a\nb\n", ["a", "b"]),
        ("a\r\nb", ["a", "b"]),
        ("\n\n", ["", ""]),
        ("a\n\x04\nb\n", ["a"]),
        ("\ta\n\x1bb\n", ["\ta"]),
        ("caf\udce9\n", ["caf\udce9"]),
    ],
)
def test_piped(text, lines):
    code = f"import sys; sys.stdin.reconfigure(errors='surrogateescape')\n{PRINT}".replace(
        "repr(line)", "ascii(line)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        input=text.encode("utf-8", "surrogateescape"),
        capture_output=True,
        timeout=20,
    )
    assert done.stdout.decode().splitlines() == [ascii(line) for line in lines]


def test_completer_asks_once_and_late():
    asked = []

    def words():
        asked.append(1)
        return ["home", "hover", "stop"]

    complete = Completer(words)
    assert asked == []
    assert [complete("ho", n) for n in range(3)] == ["home ", "hover ", None]
    assert complete("x", 0) is None
    assert asked == [1]


def test_words_behind_others_are_completed():
    typed = ""
    complete = Completer(lambda: ["get encs", "get pos joint", "set pos joint"], lambda: typed)
    assert [complete("", n) for n in range(3)] == ["get ", "set ", None]
    typed = "[get] "
    assert [complete("", n) for n in range(3)] == ["encs ", "pos ", None]
    typed = "get pos "
    assert complete("j", 0) == "joint "
    typed = "get encs 1 2 "
    assert complete("", 0) is None


def test_history_files_are_apart(monkeypatch, tmp_path):
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path))
    assert history_file("rpc_/a/b") == tmp_path / "history" / "rpc__a_b"
    assert history_file("../../x") == tmp_path / "history" / "x"
