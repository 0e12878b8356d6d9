"""Keys of a terminal, and of what is none."""

from __future__ import annotations

import io
import os
import queue
import subprocess
import sys
from collections import deque

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


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows has a console of this kind")
def test_arrows_of_a_console_are_those_of_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the console would have, since nobody can type into that of a test."""
    import msvcrt

    class Console(io.StringIO):
        def isatty(self) -> bool:
            return True

    typed = deque(["s", "\xe0", "M", "\x00", ";", "\xe0", "K", "q"])  # F1 is none of ours
    monkeypatch.setattr(sys, "stdin", Console())
    monkeypatch.setattr(msvcrt, "kbhit", lambda: bool(typed))
    monkeypatch.setattr(msvcrt, "getwch", typed.popleft)
    with keys() as pressed:
        found = "".join(pressed.get(timeout=HANG) for _ in "s\x1b[C\x1b[Dq")
    assert found == "s\x1b[C\x1b[Dq" and not typed
    typed.append("x")  # for whoever reads it next
    assert pressed.empty() and typed
