"""What is compiled already is left alone."""

from pathlib import Path

import pytest
from support.warm import compile_all, stale


def test_files_are_compiled_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
    files = [tmp_path / f"test_{name}.py" for name in "abc"]
    for path in files:
        path.write_text("def test_it():\n    assert 1 + 1 == 2\n")
    (tmp_path / "other.py").write_text("")
    assert stale(tmp_path) == files
    compile_all(files, 2)
    assert stale(tmp_path) == []
