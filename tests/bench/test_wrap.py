"""The benchmark of decorators runs, and measures what it says."""

from __future__ import annotations

import runpy
from pathlib import Path

BENCH = Path(__file__).parents[2] / "bench" / "wrap.py"


def test_it_measures_each_once() -> None:
    found = runpy.run_path(str(BENCH))["measure"](1)
    assert {name.partition(" ")[0] for name in found} == {
        *("ask", "call", "write", "publish", "frame", "Wrapyfi's", "read", "listen")
    }
    assert all(value > 0 for value in found.values())
