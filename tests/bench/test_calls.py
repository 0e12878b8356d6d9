"""The table of a message's function calls comes about; how many they are is not tested."""

import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import calls  # noqa: E402


def test_tables(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    bound: list[set[int]] = []
    monkeypatch.setattr(calls.os, "sched_setaffinity", lambda _, cores: bound.append(cores))
    monkeypatch.setattr(calls, "ROUNDS", 1)
    monkeypatch.setattr(sys, "argv", ["calls.py", "--messages", "50", "--rows", "100"])
    calls.main()
    printed = capsys.readouterr().out
    assert [len(cores) for cores in bound] == [1]
    for title in ("Both sides", "The side that asks", "The side that answers"):
        _, found, rest = printed.partition(f"{title}: ")
        assert found
        rooms, functions = rest.split("| room |")[1].split("| function |")[:2]
        assert {"| port |", "| functions in C |"} <= {
            line[: line.find("|", 2) + 1] for line in rooms.splitlines()
        }
        assert "_socket.socket" in functions
