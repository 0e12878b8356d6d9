"""What is open at the end of a program is closed: by whatever it ends."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest
from support.lasted import lasted

from yarpy import linger

PROGRAM = """
import os, signal, sys, threading, time
from yarpy import linger

def said(text):
    def close(seconds):
        assert 0.0 <= seconds <= 1.0
        os.write(1, text.encode() + b"\\n")
    return close

linger.add("first", said("first"))
linger.add("last", said("last"))
linger.add("closed", said("closed"))
linger.remove("closed")
"""


def run(*lines, **more):
    return subprocess.run(
        [sys.executable, "-c", PROGRAM + textwrap.dedent("\n".join(lines))],
        capture_output=True,
        text=True,
        timeout=60,
        **more,
    )


@pytest.mark.parametrize(
    ("end", "status"),
    [
        ("", 0),
        ("sys.exit(3)", 3),
        ("raise ZeroDivisionError", 1),
        ("threading.Thread(target=time.sleep, args=(0.1,)).start()", 0),
        ("os.kill(os.getpid(), signal.SIGINT)", -2),
    ],
)
def test_the_last_is_closed_first(end, status):
    done = run(end)
    assert done.stdout.split() == ["last", "first"]
    if os.name == "posix":
        assert done.returncode == status


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no such signals")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_ends_it_as_ever_but_in_good_order(name):
    done = run(f"os.kill(os.getpid(), signal.{name})", "time.sleep(60)")
    assert done.stdout.split() == ["last", "first"]
    assert done.returncode == -getattr(signal, name)


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no such signals")
@pytest.mark.parametrize("handler", ["signal.SIG_IGN", "lambda *_: print('mine')"])
def test_the_program_s_own_handler_is_left_alone(handler):
    done = run(
        "linger.remove('first'); linger.remove('last')",
        "assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL",
        f"mine = {handler}",
        "signal.signal(signal.SIGTERM, mine)",
        "linger.add('port', said('port'))",
        "assert signal.getsignal(signal.SIGTERM) is mine",
        "os.kill(os.getpid(), signal.SIGTERM)",
        "linger.remove('port')",
        "assert signal.getsignal(signal.SIGTERM) is mine",
        "print('end')",
    )
    assert done.stdout.split()[-1] == "end", done.stderr
    assert ("mine" in done.stdout) == ("mine" in handler)


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no such signals")
def test_a_second_signal_does_not_wait():
    done = run(
        "def hang(seconds): os.kill(os.getpid(), signal.SIGTERM); time.sleep(60)",
        "linger.add('hanging', hang)",
        "os.kill(os.getpid(), signal.SIGTERM)",
    )
    assert done.returncode == -signal.SIGTERM


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no such signals")
def test_what_hangs_is_not_waited_for_long():
    begun = time.monotonic()
    done = run(
        "linger.add('hanging', lambda seconds: time.sleep(60))",
        "os.kill(os.getpid(), signal.SIGTERM)",
        env={**os.environ, linger.SETTING: "0.1"},
    )
    assert done.returncode == -signal.SIGTERM
    assert lasted(begun) < 30


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_forked_child_has_nothing_open():
    done = run(
        "child = os.fork()",
        "if not child: time.sleep(0.1); sys.exit(7)",
        "assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7",
        "linger.remove('first'); linger.remove('last')",
    )
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_children_of_multiprocessing_end_in_good_order_too():
    done = run(
        "linger.remove('first'); linger.remove('last')",
        "import multiprocessing",
        "def work(): linger.add('child', said('child'))",
        "process = multiprocessing.get_context('fork').Process(target=work)",
        "process.start(); process.join()",
    )
    assert done.stdout.split() == ["child"], done.stderr


def test_how_long_it_may_take_is_a_setting(monkeypatch, caplog):
    monkeypatch.delenv(linger.SETTING, raising=False)
    assert linger.seconds() == linger.LINGER
    monkeypatch.setenv(linger.SETTING, "2.5")
    assert linger.seconds() == 2.5
    for wrong in ("soon", "-1", "nan", "inf"):
        monkeypatch.setenv(linger.SETTING, wrong)
        assert linger.seconds() == linger.LINGER
        assert wrong in caplog.text


@pytest.mark.parametrize(
    ("end", "status"),
    [
        ("", 0),
        ("sys.exit(3)", 3),
        ("import atexit; atexit.register(said('by atexit'), 0.0)", 0),
        pytest.param(
            "os.kill(os.getpid(), signal.SIGTERM); time.sleep(60)",
            -15,
            marks=pytest.mark.skipif(os.name != "posix", reason="this system has no such signals"),
        ),
    ],
)
def test_what_all_goes_over_ends_behind_everything_else(end, status):
    done = run(
        "linger.at_last(lambda: os.write(1, b'cable\\n'))",
        "linger.at_last(lambda: 1 / 0)",
        "linger.at_last(lambda: os.write(1, b'plug\\n'))",
        "def thread(): time.sleep(0.1); os.write(1, b'thread\\n')",
        "" if "SIGTERM" in end else "threading.Thread(target=thread).start()",
        end,
    )
    assert done.stdout.split()[-4:] == ["last", "first", "plug", "cable"], done.stderr
    assert ("thread" in done.stdout) == ("SIGTERM" not in end)
    assert done.returncode == status
    assert "ZeroDivisionError" in done.stderr


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_so_it_does_in_children_of_multiprocessing():
    done = run(
        "linger.remove('first'); linger.remove('last')",
        "import multiprocessing",
        "def work():",
        "    linger.at_last(lambda: os.write(1, b'cable\\n'))",
        "    linger.add('child', said('child'))",
        "process = multiprocessing.get_context('fork').Process(target=work)",
        "process.start(); process.join()",
    )
    assert done.stdout.split() == ["child", "cable"], done.stderr


def test_names_have_a_moment_beyond_that_all_together():
    done = run(
        "print(linger.left_for_names())",
        "left = lambda seconds: print(0.0 < linger.left_for_names() <= linger.NAMES)",
        "os.environ[linger.SETTING] = '0'",
        "linger.remove('first'), linger.remove('last')",
        "linger.add('a', left)",
    )
    assert done.stdout.split() == ["0.0", "True"], done.stderr


def test_what_is_closed_last_has_what_is_left_of_all_that():
    done = run(
        "os.environ[linger.SETTING] = '5'",
        "print(linger.left())",
        "linger.remove('first'), linger.remove('last')",
        "linger.at_last(lambda: print(linger.LINGER < linger.left() < 5 + linger.NAMES))",
    )
    assert done.stdout.split() == ["5.0", "True"], done.stderr
