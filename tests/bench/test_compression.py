"""The benchmark of the monitors for pictures runs; how fast they are is not tested."""

import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import compression  # noqa: E402


def test_tables(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", ["compression.py", "--rounds", "1"])
    monkeypatch.setattr(compression, "WATCHED", 0.02)
    compression.main()
    table = capsys.readouterr().out
    for name, _ in compression.COMPRESSION:
        assert f"| {name} | " in table
    for method in compression.METHODS:
        assert f"| {method} | " in table
