"""The benchmark of simulated robots runs; how fast anything is, is not tested."""

import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import sim  # noqa: E402


def test_both_are_measured(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("mujoco")
    sim.main(["--seconds", "0.1"])
    table = capsys.readouterr().out
    assert "| plain MuJoCo | " in table and "| robot | " in table
