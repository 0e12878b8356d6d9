"""The benchmark of recordings runs; how fast anything is, is not tested."""

import sys
from pathlib import Path

import pytest

import yarpy

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import record as bench  # noqa: E402

ROWS = {
    "recorder": ("from 3 ports", "C++ YARP is left out", "from 1 ports", "plain writes", "of 1 s"),
    "files": ("plain writes", "plain reads", "library mcap", "small message read", "`info`"),
    "player": ("300 messages", "p99", "of 300 MB"),
}


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="it looks into /proc")
@pytest.mark.parametrize("part", ROWS)
def test_tables(
    part: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    small = ["--seconds", "0.3", "--ports", "3", "--size", "160x120", "--rounds", "1", "--no-cpp"]
    sizes = ["--bytes", "10000000", "--info", "50000000", "--folder", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", ["record.py", *small, *sizes, "--parts", part])
    with yarpy.NameServer() as server:
        for name in server.environment:
            monkeypatch.setenv(name, "")
    bench.main()
    table = capsys.readouterr().out
    for row in ROWS[part]:
        assert row in table
    assert [*tmp_path.iterdir()] == []
