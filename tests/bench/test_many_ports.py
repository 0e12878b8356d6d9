"""The benchmark of many ports runs; how fast they are is not tested."""

import sys
from pathlib import Path

import pytest
from support.cpp import CppYarp, MissingPeer

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import many_ports  # noqa: E402


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="it looks into /proc")
def test_table(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def missing(home: Path) -> CppYarp:
        raise MissingPeer("not for this test")

    monkeypatch.setattr(CppYarp, "prepare", missing)
    small = ["--rounds", "1", "--ports", "3", "--connections", "0"]
    monkeypatch.setattr(sys, "argv", ["many_ports.py", *small])
    many_ports.main()
    table = capsys.readouterr().out
    for who in ("no server", "yarpy server"):
        assert f"| yarpy, {who} | 3 | " in table
