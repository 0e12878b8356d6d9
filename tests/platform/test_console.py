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
# wine nobody can send Ctrl-Break to a program without a terminal.)
PORT = """
import os, signal, sys, threading, time, yarpy
from yarpy.platform import console

def ends():
    sys.stdin.readline()
    console._told[0](1)
    os._exit(5)

threading.Thread(target=ends, daemon=True).start()
port = yarpy.Port("/asked/to/end")
{before}
print("open", flush=True)
{then}
"""
WAYS = {
    "it sleeps": ("", "time.sleep(600)"),
    "it reads": (
        "",
        "try: port.read()\nexcept yarpy.PortClosed: time.sleep(600)",
    ),
    "it has a handler of its own": ("signal.signal(signal.SIGBREAK, print)", "time.sleep(600)"),
}


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows asks a program by its console")
@pytest.mark.parametrize("way", WAYS)
def test_a_program_of_ports_gives_its_name_back(way: str) -> None:
    before, then = WAYS[way]
    with yarpy.NameServer() as server:
        with subprocess.Popen(
            [sys.executable, "-c", PORT.format(before=before, then=then)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, **server.environment},
        ) as program:
            assert program.stdin is not None and program.stdout is not None
            assert program.stdout.readline().strip() == b"open"
            assert yarpy.query("/asked/to/end") is not None
            program.stdin.write(b"\n")
            program.stdin.flush()
            assert program.wait(HANG) == 5
        assert (yarpy.query("/asked/to/end") is None) == (way != "it has a handler of its own")


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
