"""Libraries that a program has imported."""

from __future__ import annotations

import importlib
import json
import sys
import threading
from pathlib import Path

import pytest

from yarpy.data import codec
from yarpy.data.python.loaded import loaded


def test_what_is_imported() -> None:
    assert loaded("json") is json
    assert loaded("no_such_library_of_a_test") is None


@pytest.mark.parametrize("value", ["text", 1.5, b"bytes", [1, "two", [3.0]], {"a": (1,)}, None])
def test_values_are_sent_while_another_thread_imports_numpy(
    value: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program reads its first picture, which imports numpy, and writes meanwhile."""
    expected = codec.encode(value)
    begun, go_on = threading.Event(), threading.Event()
    monkeypatch.setattr(sys, "test_of_loaded", (begun, go_on), raising=False)
    (tmp_path / "numpy.py").write_text(
        "import sys\nbegun, go_on = sys.test_of_loaded\nbegun.set()\ngo_on.wait(30)\n",
        encoding="utf-8",
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "numpy", raising=False)
    thread = threading.Thread(target=importlib.import_module, args=("numpy",))
    thread.start()
    try:
        assert begun.wait(30.0)
        assert "numpy" in sys.modules and loaded("numpy") is None
        assert codec.encode(value) == expected
    finally:
        go_on.set()
        thread.join()
        assert loaded("numpy") is not None
        monkeypatch.delitem(sys.modules, "numpy")
