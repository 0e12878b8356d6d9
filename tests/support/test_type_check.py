"""Types are checked, strictly."""

from pathlib import Path

import pytest
from support.type_check import type_check


@pytest.mark.timeout(300)
def test_it_tells_right_from_wrong(tmp_path: Path) -> None:
    (tmp_path / "good.py").write_text("def f(x: int) -> int:\n    return x\n")
    (tmp_path / "bad.py").write_text("def f(x: int):\n    return x\n")
    assert type_check(tmp_path, "good.py").returncode == 0
    assert "missing a return type" in type_check(tmp_path, "bad.py").stdout
