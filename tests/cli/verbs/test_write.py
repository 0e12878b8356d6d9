"""`yarpy write`."""

import signal
import subprocess
import sys
from typing import NamedTuple

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.verbs.write import taken, value_of


@pytest.fixture
def reader(names):
    with yarpy.BufferedPort("/write/reader", strict=True, names=names) as port:
        yield port


def values(reader, count):
    return [reader.read(timeout=HANG).value for _ in range(count)]


def test_sends_lines(cli, reader):
    text = '1 ping 3.14\nhello\r\n(a (1 2)) [set]\n\n  blanks  \n"two words"\nno end'
    said = cli.run("write", "/write/a", "/write/reader", input=text)
    assert (said.returncode, said.stdout) == (0, "")
    assert values(reader, 7) == [
        [1, "ping", 3.14],
        ["hello"],
        [["a", [1, 2]], "set"],
        [],
        ["blanks"],
        ["two words"],
        ["no", "end"],
    ]
    assert reader.waiting == 0


def test_verbatim(cli, reader):
    said = cli.run("write", "/write/a", "verbatim", "/write/reader", input='1 ping\nhello "q')
    assert said.returncode == 0
    assert values(reader, 3) == [[0, "1 ping"], [0, 'hello "q'], [1, "<EOF>"]]


def test_a_control_character_ends_the_input(cli, reader):
    said = cli.run("write", "/write/a", "/write/reader", input="x\n\ty\n\x04\nz\n")
    assert said.returncode == 0
    assert values(reader, 2) == [["x"], ["y"]]
    assert reader.waiting == 0


def test_several_readers_and_carriers(cli, names, reader):
    with yarpy.BufferedPort("/write/other", names=names) as other:
        words = ("write", "/write/a", "/write/reader", "fast_tcp://write/other")
        assert cli.run(*words, input="x\n").returncode == 0
        assert values(reader, 1) == values(other, 1) == [["x"]]


def test_waits_for_a_connection(cli, reader):
    with cli.start("write", "/write/a", "--wait-connect") as process:
        process.write_line("first")
        process.end_input()
        process.wait_line("active", stream="err")
        reader.listen_to("/write/a")
        assert process.wait() == 0
    assert values(reader, 1) == [["first"]]


def test_period(cli, reader):
    with cli.start("write", "/write/a", "/write/reader", "--period", "0.05") as process:
        process.wait_line("published with a period of 0.050000 s", stream="err")
        process.write_line("x")
        assert values(reader, 4) == [["x"]] * 4
        process.write_line("y")
        while reader.read(timeout=HANG).value != ["y"]:
            pass
        assert values(reader, 2) == [["y"]] * 2
        process.end_input()
        assert process.wait() == 0


@pytest.mark.parametrize("period", ["0", "-1", "x"])
def test_wrong_period(here, period):
    assert here("write", "/write/a", "--period", period).code == 1


def test_a_remote_that_is_not_there(cli, names):
    said = cli.run("write", "/write/a", "/nobody", input="x\n")
    assert said.returncode == 1
    assert 'error: no port "/nobody" is registered' in said.stderr
    assert names.query("/write/a") is None


def test_a_living_name_is_refused(here, reader):
    said = here("write", "/write/reader")
    assert said.code == 1 and "is in use" in said.err


def test_a_signal_closes_it_in_good_order(cli, reader, names):
    with cli.start("write", "/write/a", "/write/reader") as process:
        process.write_line("x")
        assert values(reader, 1) == [["x"]]
        process.signal(signal.SIGTERM)
        assert process.wait() == 1
    assert "Interrupting..." in process.stderr
    assert names.query("/write/a") is None
    wait_until(lambda: not reader.inputs)


def test_type_of_the_port(cli, reader, names):
    with cli.start("write", "/write/a", "--type", "yarp/image") as process:
        process.wait_line("active", stream="err")
        assert names.get("/write/a", "type") == ["yarp/image"]


def test_value_of():
    assert value_of("1 x", verbatim=False) == [1, "x"]
    assert value_of("1 x", verbatim=True) == [0, "1 x"]
    with pytest.raises(yarpy.DecodeError):
        value_of("(" * 500 + ")" * 500, verbatim=False)


class Outputs:
    """A port of whose messages so many are still on their way, one time after the other."""

    def __init__(self, *unacknowledged):
        self.left = list(unacknowledged)
        self.stats = self

    def flush(self, timeout):
        return not self.left

    @property
    def outputs(self):
        return [Output("/reader", 9, self.left.pop(0))]


class Output(NamedTuple):
    target: str
    messages: int
    unacknowledged: int


def test_a_slow_reader_is_waited_for():
    assert taken(Outputs(9, 7, 2), standstill=0.0)


def test_a_reader_that_was_stopped_is_not_waited_for_for_ever(capsys):
    assert not taken(Outputs(9, 2, 2, 2), standstill=0.0)
    assert "nothing was taken for 0 s by /reader" in capsys.readouterr().err


def test_a_connection_that_broke_is_not_waited_for():
    assert taken(Outputs(9, 9), standstill=3600.0)


# What Windows asks a program by is Ctrl-Break of a console, which tests have not. wine 8 sends none
# (GenerateConsoleCtrlEvent: an invalid handle) but Ctrl-C, which a new process group ignores until
# it does so no more.
ASKED = """
import ctypes, signal, subprocess, sys
COMMAND = '''
import ctypes, sys
ctypes.WinDLL("kernel32").SetConsoleCtrlHandler(None, False)
from yarpy.__main__ import main
sys.argv = ["yarpy", "write", "/write/asked", "/write/reader"]
main()
'''
import yarpy
kernel = ctypes.WinDLL("kernel32")
kernel.SetConsoleCtrlHandler(None, True)
with (
    yarpy.BufferedPort("/write/reader") as reader,
    subprocess.Popen([sys.executable, "-c", COMMAND], stdin=subprocess.PIPE,
                     creationflags=subprocess.CREATE_NEW_PROCESS_GROUP) as command,
):
    command.stdin.write(b"x\\n")
    command.stdin.flush()
    print(reader.read().value)
    event = signal.CTRL_BREAK_EVENT
    kernel.GenerateConsoleCtrlEvent(event, command.pid) or kernel.GenerateConsoleCtrlEvent(
        signal.CTRL_C_EVENT, command.pid)
    print(command.wait(), yarpy.query("/write/asked"))  # its input is still open
"""


@pytest.mark.skipif(sys.platform != "win32", reason="elsewhere a signal ends a read")
def test_a_console_ends_it_where_nothing_is_typed(cli):
    done = subprocess.run(
        [sys.executable, "-c", ASKED],
        input="",
        capture_output=True,
        text=True,
        timeout=HANG,
        env=cli.environment,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    assert done.stdout.splitlines() == ["Bottle(['x'])", "1 None"]
    assert "Interrupting..." in done.stderr.splitlines()
