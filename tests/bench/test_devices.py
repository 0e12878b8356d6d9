"""The benchmark of devices runs; how fast anything is, is not tested."""

import sys
from pathlib import Path

import pytest

import yarpy

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import devices  # noqa: E402


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="it looks into /proc")
def test_table(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with yarpy.NameServer() as server:
        for name in server.environment:
            monkeypatch.setenv(name, "")  # the benchmark's own, which goes with this test
    devices.main(["--seconds", "0.2", "--joints", "3", "--rate", "100", "--calls", "20"])
    table = capsys.readouterr().out
    for row in ("state, 3 joints", "encoders of 3 joints", "RGBD 640 x 480"):
        assert f"| {row} | " in table
