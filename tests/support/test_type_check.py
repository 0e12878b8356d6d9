"""Types are checked, strictly."""

from pathlib import Path

import pytest
from support.type_check import type_check


@pytest.mark.timeout(300)
def test_it_tells_right_from_wrong(tmp_path: Path) -> None:
    (tmp_path / "good.py").write_text("def f(x: int) -> int:\n    return x\n")
    (tmp_path / "bad.py").write_text("def f(x: int):\n    return x\n")
    said = type_check(tmp_path, "good.py", "bad.py").stdout
    assert "good.py" not in said
    assert "bad.py:1: error: Function is missing a return type" in said
