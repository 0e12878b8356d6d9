"""Signals end commands in good order."""

import signal
import subprocess
import sys
import time

import pytest
from support.wait import HANG

from yarpy.cli.signals import Interrupted, held

if sys.platform == "win32":
    pytest.skip("no other program sends signals on Windows", allow_module_level=True)

ENDINGS = [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]


@pytest.mark.parametrize(("number", "code"), ENDINGS)
def test_a_signal_ends_quietly(cli, number, code):
    with cli.start("time") as process:
        process.wait_line(r"\d")
        process.signal(number)
        assert process.wait() == code
        assert process.stderr == ""


def test_names_are_given_back(cli, names):
    with cli.start("repeat", "/ending/repeat") as process:
        process.wait_line("active")
        assert names.query("/ending/repeat") is not None
        process.signal(signal.SIGTERM)
        assert process.wait() == 143
    assert names.query("/ending/repeat") is None


def test_a_shell_that_ignores_sigint_for_background_jobs(cli):
    start = "import os, signal, sys; signal.signal({}, signal.SIG_IGN); os.execv(*{!r})"
    command = [sys.executable, "-m", "yarpy", "time"]
    for number, code in ((signal.SIGINT, 130), (signal.SIGHUP, None)):
        with subprocess.Popen(
            [sys.executable, "-c", start.format(int(number), (sys.executable, command))],
            env=cli.environment,
            stdout=subprocess.PIPE,
        ) as process:
            assert process.stdout is not None
            process.stdout.readline()
            process.send_signal(number)
            if code is None:
                time.sleep(0.3)
                assert process.poll() is None  # nohup
                process.kill()
            else:
                assert process.wait() == code


STUCK = """
import time
from yarpy.cli import signals
signals.watch()
try:
    print("waiting", flush=True)
    time.sleep(30)
except signals.Interrupted:
    print("closing", flush=True)
    time.sleep(30)
"""


def test_a_second_signal_ends_what_is_stuck_in_closing(cli):
    with yarpy_process(STUCK) as process:
        assert process.stdout.readline() == "waiting\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "closing\n"
        process.send_signal(signal.SIGINT)  # the same person, pressing twice
        time.sleep(0.2)
        assert process.poll() is None
        time.sleep(2.0)
        process.send_signal(signal.SIGINT)
        assert process.wait() == 130


def yarpy_process(code):
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)


def test_is_no_exception_that_code_swallows():
    assert not issubclass(Interrupted, Exception)
    assert Interrupted(15).number == 15


def test_held_without_a_watch_holds_nothing():
    with pytest.raises(ZeroDivisionError), held():
        raise ZeroDivisionError


LOST = """
import os, signal, time
from yarpy.cli import signals
class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(0.05)  # the signal is handled here, where Python drops what is raised
signals.watch()
try:
    Dying()
    print("going on", flush=True)
    time.sleep(30)
except signals.Interrupted as signal_:
    print("ended by", signal_.number, flush=True)
"""


def test_a_signal_that_comes_where_python_drops_exceptions_is_not_lost():
    """In a finaliser, or a callback of an import: it used to be printed and forgotten."""
    done = subprocess.run(
        [sys.executable, "-c", LOST], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.splitlines()[-1] == f"ended by {int(signal.SIGTERM)}"
    assert "Exception ignored" not in done.stderr


STARTING = """
import os, signal, threading, time
from yarpy.cli import signals
class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(0.05)
signals.watch()
try:
    with threading._active_limbo_lock:  # as in the start of a thread, where it may be collected
        Dying()
    threading.Event().wait()
except signals.Interrupted as signal_:
    print("ended by", signal_.number, flush=True)
"""


def test_a_signal_that_is_dropped_while_a_thread_starts_is_not_lost_either():
    """Raised again by a thread, which could not be started then: the command waited for ever."""
    done = subprocess.run(
        [sys.executable, "-c", STARTING], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.splitlines() == [f"ended by {int(signal.SIGTERM)}"]


FAILING = """
import os, signal
from yarpy.cli import signals
signals.watch()
try:
    with signals.held():
        os.kill(os.getpid(), signal.SIGINT)
        raise ValueError("taken")
except signals.Interrupted as signal_:
    print("ended by", signal_.number)
"""


def test_a_signal_that_waits_is_not_forgotten_where_the_block_fails():
    done = subprocess.run(
        [sys.executable, "-c", FAILING], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.splitlines() == [f"ended by {int(signal.SIGINT)}"]


ELSEWHERE = """
import signal, threading, time
from yarpy.cli import signals
signals.watch()
thread = threading.Thread(target=time.sleep, args=(30,), daemon=True)
thread.start()
try:
    threading.Timer(0.2, lambda: signal.pthread_kill(thread.ident, signal.SIGTERM)).start()
    threading.Event().wait()
except signals.Interrupted as signal_:
    print("ended by", signal_.number, flush=True)
"""


def test_a_signal_that_another_thread_gets_wakes_the_main_thread():
    """As happens while connections end: the main thread slept on, and ^C seemed to do nothing."""
    done = subprocess.run(
        [sys.executable, "-c", ELSEWHERE], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.splitlines()[-1] == f"ended by {int(signal.SIGTERM)}"
