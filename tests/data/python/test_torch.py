"""Tensors of a real torch: Debian's, and the one of this Python where there is one."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from support.peer import DEBIAN_PYTHON
from support.process import Process
from support.wait import HANG

ROOT = Path(__file__).parents[3]
PROGRAM = Path(__file__).parent / "programs/tensors.py"


def check(python: str | Path) -> None:
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(ROOT / "src")}
    with Process([python, "-W", "ignore", PROGRAM], env=environment) as process:
        process.wait_line("^well$", timeout=2 * HANG, stream="out")


@pytest.mark.peer("torch")
def test_tensors_of_debian() -> None:
    check(DEBIAN_PYTHON)


@pytest.mark.skipif(find_spec("torch") is None, reason="torch is not here: pip install torch")
def test_tensors_of_this_python() -> None:
    check(sys.executable)
