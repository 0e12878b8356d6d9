"""The conformance suite as a whole: for pytest and without it, with words for a reader.

Every shipped carrier passes it in tests/carriers; its teeth are tested beside its two halves.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

from yarpy.testing import CarrierConformance
from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.testing.conformance_live import LiveConformance


def test_suite_works_without_pytest(tmp_path: Path) -> None:
    """Its methods are plain; `import yarpy.testing` loads no pytest."""
    code = """
import sys
sys.modules["pytest"] = None
from unittest import SkipTest
from yarpy.carriers.own.tcp import Tcp
from yarpy.testing import CarrierConformance
class Suite(CarrierConformance):
    carrier = Tcp
count = 0
for name in dir(Suite):
    if name.startswith("test_"):
        try:
            getattr(Suite(), name)()
            count += 1
        except SkipTest:
            pass
print(count)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) >= 17


def test_suite_is_found_by_pytest_through_a_subclass() -> None:
    """Names of tests are what a reader of a report sees."""
    tests = [name for name in dir(CarrierConformance) if name.startswith("test_")]
    assert all(getattr(CarrierConformance, name).__doc__ for name in tests)
    assert not CarrierConformance.__name__.startswith("Test")
    values: Any = CarrierConformance.values
    assert len(values) > 8


def test_nothing_of_one_half_hides_behind_the_other() -> None:
    halves = [
        {name for name in dir(half) if name.startswith("test_")}
        for half in (DialogueConformance, LiveConformance)
    ]
    assert halves[0] and halves[1] and not halves[0] & halves[1]
