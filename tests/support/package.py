"""Install one of the packages below `examples/` by pip, as a stranger's: nothing is fetched."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def install(package: str, factory: pytest.TempPathFactory) -> Path:
    """A folder of its own that holds the package, for PYTHONPATH."""
    pytest.importorskip("hatchling", reason="the build backend comes with yarpy[test]")
    target = factory.mktemp("site")
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--no-cache-dir"]
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", *options]
    done = subprocess.run(
        [*command, "--target", str(target), str(EXAMPLES / package)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return target
