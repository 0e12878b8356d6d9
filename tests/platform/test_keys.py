"""Keys of a terminal, and of what is none."""

from __future__ import annotations

import io
import os
import queue
import subprocess
import sys

import pytest
from support.wait import HANG

from yarpy.platform.keys import keys

PROGRAM = """
from yarpy.platform.keys import keys
with keys() as pressed:
    print("ready", flush=True)
    while (key := pressed.get()) != "q":
        print(ascii(key), flush=True)
"""


def test_what_is_no_terminal_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("qqq"))
    with keys() as pressed, pytest.raises(queue.Empty):
        pressed.get(timeout=0.1)


@pytest.mark.skipif(sys.platform == "win32", reason="terminals of this kind are Unix'")
def test_letters_of_a_terminal_come_at_once() -> None:
    ours, theirs = os.openpty()
    with (
        open(ours, "rb+", buffering=0) as typed,
        subprocess.Popen(
            [sys.executable, "-c", PROGRAM], stdin=theirs, stdout=subprocess.PIPE, text=True
        ) as program,
    ):
        os.close(theirs)
        assert program.stdout is not None
        assert program.stdout.readline() == "ready\n"
        typed.write("s \x1b[Cäq".encode())
        said = program.communicate(timeout=HANG)[0]
        assert said.splitlines() == [ascii(letter) for letter in "s \x1b[Cä"]


# A console of its own, and in it what a keyboard would have put there: letters, an arrow to the
# right, F1, and an à, which begins as arrows do.
CONSOLE = """
import ctypes, sys
from ctypes import wintypes
from yarpy.platform.keys import keys

class Key(ctypes.Structure):
    _fields_ = [("kind", wintypes.DWORD), ("down", wintypes.BOOL), ("count", wintypes.WORD),
        ("key", wintypes.WORD), ("scan", wintypes.WORD), ("letter", wintypes.WCHAR),
        ("state", wintypes.DWORD)]

kernel = ctypes.WinDLL("kernel32")
kernel.CreateFileW.restype = ctypes.c_void_p
console = ctypes.c_void_p(kernel.CreateFileW("CONIN$", 0xC0000000, 3, None, 3, 0, None))

def press(letter, key=0, scan=0, state=0):
    for down in (1, 0):
        one = Key(1, down, 1, key, scan, letter, state)
        count = wintypes.DWORD()
        assert kernel.WriteConsoleInputW(console, ctypes.byref(one), 1, ctypes.byref(count))

sys.stdin = open("CONIN$")
with keys() as pressed:
    press("s", 0x53, 0x1F)
    press("\\0", 0x27, 0x4D, 0x100)
    press("\\0", 0x70, 0x3B)
    press("\\xe0")
    print(ascii([pressed.get(timeout=60) for _ in range(5)]), flush=True)
    press("q", 0x51, 0x10)
    print(pressed.get(timeout=60), flush=True)
press("x")  # for whoever reads it next
assert pressed.empty()
print("over", flush=True)
"""


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows has a console of this kind")
def test_keys_of_a_console_are_those_of_a_terminal() -> None:
    done = subprocess.run(
        [sys.executable, "-c", CONSOLE],
        input="",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=HANG,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    assert done.stdout.splitlines() == [ascii([*"s\x1b[C\xe0"]), "q", "over"], done.stdout
