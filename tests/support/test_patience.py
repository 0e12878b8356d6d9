"""Patience comes from the environment."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize(("factor", "expected"), [("", "2.0"), ("3", "6.0"), ("0.5", "1.0")])
def test_patience_is_multiplied(factor: str, expected: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", "from support.patience import patience; print(patience(2.0))"],
        env={**os.environ, "YARPY_TEST_PATIENCE": factor},
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        timeout=30,
    )
    assert done.stdout.strip() == expected, done.stderr
