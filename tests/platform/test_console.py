"""A console that ends, or wants the program to."""

from __future__ import annotations

import errno
import os
import subprocess
import sys

import pytest
from support.wait import HANG

import yarpy
from yarpy.platform.console import is_unread

# What the system does: a thread of its own calls what was registered, and ends the process. (Under
# wine nobody can send Ctrl-Break to a program without a terminal, and no window of it ends.)
PORT = """
import os, signal, sys, threading, time, yarpy
from yarpy.platform import console

def ends():
    sys.stdin.readline()
    console._told[0]({event})
    os._exit(5)

def ended(*_):
    print("my own", flush=True)
    port.close()

threading.Thread(target=ends, daemon=True).start()
port = yarpy.Port("/asked/to/end")
{before}
print("open", flush=True)
{then}
"""
BREAK, WINDOW = 1, 2  # CTRL_BREAK_EVENT; CTRL_CLOSE_EVENT, behind which the process ends
OWN = "signal.signal(signal.SIGBREAK, {})"
READS = "try: port.read()\nexcept yarpy.PortClosed: time.sleep(600)"
SLEEPS = "time.sleep(600)"
WAYS = {  # what it does before and then, the event, what it says, whether the name is given back
    "it sleeps": ("", SLEEPS, BREAK, [], True),
    "it reads": ("", READS, BREAK, [], True),
    "a window ends": ("", SLEEPS, WINDOW, [], True),
    "it has a handler of its own": (OWN.format("print"), SLEEPS, BREAK, [], False),
    "a window ends its own handler": (OWN.format("ended"), READS, WINDOW, ["my own"], True),
    "its own handler does nothing": (OWN.format("print"), SLEEPS, WINDOW, [], True),
}


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows asks a program by its console")
@pytest.mark.parametrize("way", WAYS)
def test_a_program_of_ports_gives_its_name_back(way: str) -> None:
    before, then, event, said, given_back = WAYS[way]
    with yarpy.NameServer() as server:
        with subprocess.Popen(
            [sys.executable, "-c", PORT.format(before=before, then=then, event=event)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, **server.environment},
        ) as program:
            assert program.stdin is not None and program.stdout is not None
            assert program.stdout.readline() == "open\n"
            assert yarpy.query("/asked/to/end") is not None
            program.stdin.write("\n")
            program.stdin.flush()
            assert program.wait(HANG) == 5
            assert program.stdout.read().splitlines() == said
        assert (yarpy.query("/asked/to/end") is None) == given_back


def test_a_pipe_that_nobody_reads() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    try:
        with pytest.raises(OSError) as raised:
            os.write(writing, b"x")
    finally:
        os.close(writing)
    assert is_unread(raised.value)
    assert not is_unread(OSError(errno.ENOSPC, "no space left"))


ESCAPES = """
import ctypes, msvcrt
from yarpy.platform.console import obey_escapes

def mode(stream):
    found = ctypes.c_ulong()
    handle = ctypes.c_void_p(msvcrt.get_osfhandle(stream.fileno()))
    assert ctypes.WinDLL("kernel32").GetConsoleMode(handle, ctypes.byref(found))
    return found.value

with open("CONOUT$", "w") as stream:
    handle = ctypes.c_void_p(msvcrt.get_osfhandle(stream.fileno()))
    ctypes.WinDLL("kernel32").SetConsoleMode(handle, mode(stream) & ~4)
    assert not mode(stream) & 4
    obey_escapes(stream)
    assert mode(stream) & 4
with open("nul", "w") as stream:
    obey_escapes(stream)
print("done")
"""


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows has a console of this kind")
def test_a_console_obeys_escape_sequences() -> None:
    done = subprocess.run(
        [sys.executable, "-c", ESCAPES],
        input="",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=HANG,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    assert done.stdout == "done\n"
