"""The benchmark of a camera with several readers runs; how fast anything is, is not tested."""

import sys
from pathlib import Path

import pytest

import yarpy

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import camera  # noqa: E402


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="it looks into /proc")
def test_table(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    small = ["--rounds", "1", "--seconds", "0.2", "--readers", "1", "--size", "160x120"]
    monkeypatch.setattr(sys, "argv", ["camera.py", *small])
    monkeypatch.setattr(camera, "CARRIERS", ("memory", "tcp"))
    with yarpy.NameServer() as server:
        for name in server.environment:
            monkeypatch.setenv(name, "")
    camera.main()
    table = capsys.readouterr().out
    for carrier in camera.CARRIERS:
        assert f"| {carrier} | " in table
