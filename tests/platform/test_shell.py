"""Lines for the shell of this system do there what they are for."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from support.wait import HANG

from yarpy.platform.shell import no_setting, quoted, setting

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


def test_a_word(tmp_path: Path) -> None:
    program = tmp_path / "ask.py"
    program.write_text(ASK)
    url = "http://127.0.0.1:10000/?req=query+$port&port=/a b"
    assert said(tmp_path, f"{sys.executable} {program} {quoted(url)}") == f"None ['{url}']"
