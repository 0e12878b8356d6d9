"""The benchmark of Thrift calls runs; how fast they are is not tested."""

import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import thrift_call  # noqa: E402


def test_table(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("lark")
    assert thrift_call.main(["--rounds", "1"]) == 0
    table = capsys.readouterr().out.splitlines()
    assert len(table) == 4 and all(line.count(" us") == 2 for line in table[1:])
