"""A test that takes too long is found, whatever was watched before."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from support.wait import HANG, wait_until
from support.watchdog import Watchdog

TESTS = Path(__file__).parents[1]


def test_what_is_watched_last_expires() -> None:
    expired: list[Any] = []
    watchdog = Watchdog(lambda item, settings: expired.append(item), period=0.01)
    soon, late = SimpleNamespace(timeout=0.05), SimpleNamespace(timeout=1000.0)
    watchdog.watch("it ends in time", soon)
    watchdog.rest()
    watchdog.watch("another comes", soon)
    watchdog.watch("it has time", late)
    assert expired == []
    watchdog.watch("it hangs", soon)
    wait_until(lambda: expired)
    assert expired == ["it hangs"]


def test_a_test_that_hangs_is_shown_and_ended(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        "from support.watchdog import TimeLimits\n"
        "def pytest_configure(config):\n"
        "    config.pluginmanager.register(TimeLimits())\n"
    )
    (tmp_path / "test_hang.py").write_text(
        "import threading\ndef test_hang():\n    threading.Event().wait()\n"
    )
    options = ("--timeout=0.2", "--timeout-method=thread", "-o", f"pythonpath={TESTS}")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *options, str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=2 * HANG,
    )
    assert done.returncode == 1
    assert "Timeout" in done.stdout and "threading.Event().wait()" in done.stdout
