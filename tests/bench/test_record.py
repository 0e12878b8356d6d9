"""The benchmark of recordings runs; how fast anything is, is not tested."""

import sys
from pathlib import Path

import pytest

import yarpy

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import record as bench  # noqa: E402


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="it looks into /proc")
def test_tables(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    small = ["--seconds", "0.3", "--ports", "3", "--size", "160x120", "--rounds", "1"]
    monkeypatch.setattr(
        sys, "argv", ["record.py", *small, "--bytes", "10000000", "--folder", str(tmp_path)]
    )
    with yarpy.NameServer() as server:
        for name in server.environment:
            monkeypatch.setenv(name, "")
    bench.main()
    table = capsys.readouterr().out
    assert "from 3 ports" in table and "from 1 ports" in table
    for row in ("plain writes", "reading it", "yarpy info", "small message read", "300 messages"):
        assert row in table
    assert [*tmp_path.iterdir()] == []
