"""Lines for the shell of this system do there what they are for."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support.wait import HANG

from yarpy.platform.shell import no_setting, quoted, setting

SHOWN = "from yarpy.platform import shell as s; print(s.setting('A', '1'), s.no_setting('A'), "
SHOWN += "s.quoted('/a'), s.quoted('$b'))"

ASK = "import os, sys; print(os.environ.get('YARPY_HERE'), sys.argv[1:])"


def said(tmp_path: Path, *lines: str) -> str:
    """What the last of these lines prints, run by the shell of this system."""
    if sys.platform == "win32":
        script = tmp_path / "lines.bat"
        script.write_text("\n".join(("@echo off", *lines, "")))
        command = [os.environ["COMSPEC"], "/c", str(script)]
    else:
        command = ["sh", "-c", "\n".join(lines)]
    return subprocess.run(
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=HANG
    ).stdout.strip()


def test_a_setting_and_none(tmp_path: Path) -> None:
    program = tmp_path / "ask.py"
    program.write_text(ASK)
    ask = f"{sys.executable} {program}"
    assert said(tmp_path, setting("YARPY_HERE", "127.0.0.1:10000"), ask) == "127.0.0.1:10000 []"
    assert said(tmp_path, setting("YARPY_HERE", "1"), no_setting("YARPY_HERE"), ask) == "None []"


@pytest.mark.skipif(sys.platform != "win32", reason="the other systems have shells of one kind")
@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("pwsh.exe", "$env:A = '1' $env:A = $null /a '$b'"),
        ("cmd.exe", 'set A=1 set A= /a "$b"'),
    ],
)
def test_windows_has_shells_of_two_kinds(tmp_path: Path, name: str, lines: str) -> None:
    shell, program = tmp_path / name, tmp_path / "shown.py"
    # Only its name tells. Wine has a powershell.exe of its own, and would run that.
    shutil.copy(os.environ["COMSPEC"], shell)
    program.write_text(SHOWN)
    done = subprocess.run(
        [str(shell), "/c", sys.executable, str(program)],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=HANG,
    )  # fmt: skip
    assert done.stdout.strip() == lines


def test_a_word(tmp_path: Path) -> None:
    program = tmp_path / "ask.py"
    program.write_text(ASK)
    url = "http://127.0.0.1:10000/?req=query+$port&port=/a b"
    assert said(tmp_path, f"{sys.executable} {program} {quoted(url)}") == f"None ['{url}']"
