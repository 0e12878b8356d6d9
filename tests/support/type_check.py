"""mypy and pyright, for what is written for programs: stubs, generated modules, the public API.

Rules: they check from the folder of the program, mypy strictly; what it has learnt of numpy and of
yarpy stays in the checkout's cache, since to learn that takes it ten seconds: in one for each set
of options, as what it learnt with another is of no use to it. pyright is a program of Node.js,
which is a peer; yarpy's extra `test` brings pyright itself.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pytest

CACHE = Path(__file__).parents[2] / ".mypy_cache" / "tests"


STRICT: Final = ("--strict",)
#: as an editor looks at a program without type hints
LOOSE: Final = (
    *("--check-untyped-defs", "--no-strict-optional", "--ignore-missing-imports"),
    *("--allow-redefinition-new", "--local-partial-types"),
)


def type_check(
    folder: Path, *files: str, env: Mapping[str, str] = os.environ, options: Sequence[str] = STRICT
) -> subprocess.CompletedProcess[str]:
    """What mypy says about files in a folder."""
    pytest.importorskip("mypy", reason="mypy reads it: pip install mypy")
    cache = CACHE / ("strict" if options == STRICT else "loose")
    return subprocess.run(
        [sys.executable, "-m", "mypy", *options, "--cache-dir", str(cache), *files],
        cwd=folder,
        env=env,
        capture_output=True,
        text=True,
        timeout=240,
    )


@dataclass(frozen=True)
class Fault:
    """What a checker says about a line of a file."""

    file: str
    line: int
    text: str


#: to be what `pytest.mark.parametrize("checker", CHECKERS)` takes
CHECKERS: Final = ("mypy", pytest.param("pyright", marks=pytest.mark.peer("node")))
_MYPY: Final = re.compile(r"^([^\s:]+):(\d+): error: (.*)$", re.MULTILINE)


def faults(checker: str, folder: Path, *files: str, strict: bool = True) -> list[Fault]:
    """What "mypy" or "pyright" finds fault with in files of a folder."""
    if checker == "mypy":
        done = type_check(folder, *files, options=STRICT if strict else LOOSE)
        assert done.returncode in (0, 1), done.stdout + done.stderr
        return [Fault(file, int(line), text) for file, line, text in _MYPY.findall(done.stdout)]
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable]
    done = subprocess.run(
        [*command, *files], cwd=folder, capture_output=True, text=True, timeout=240
    )
    assert done.returncode in (0, 1) and done.stdout, done.stdout + done.stderr
    return [
        Fault(Path(one["file"]).name, one["range"]["start"]["line"] + 1, one["message"])
        for one in json.loads(done.stdout)["generalDiagnostics"]
        if one["severity"] == "error"
    ]
