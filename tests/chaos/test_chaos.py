"""The short form of `make chaos` and `make soak`: everything happens, and its promises hold."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from chaos.experiments import Row, all_of
from chaos.network import Missing
from chaos.soak import soak
from support.process import Process
from support.wait import HANG

pytestmark = pytest.mark.timeout(180)

KILLS = Path(__file__).with_name("kills.py")


@pytest.mark.parametrize(
    "experiment",
    [
        pytest.param(one, marks=pytest.mark.peer(*one.peers) if hasattr(one, "peers") else ())
        for one in all_of(0.03)
    ],
)
def test_experiment(experiment: Callable[[], Row]) -> None:
    try:
        row = experiment()
    except Missing as missing:
        pytest.skip(str(missing))
    assert row.what
    assert row.times
    assert row.result


def test_kills() -> None:
    """In a program of its own, since it forks."""
    with Process([sys.executable, KILLS, "10"]) as process:
        assert process.wait(2 * HANG) == 0, process.stderr
        told = re.findall(
            r"(memory of ours|descriptors) +(\d+) before +(\d+) after", process.stdout
        )
    assert len(told) == 4
    assert all(before == after for _, before, after in told), process.stdout
    assert process.stdout.count("5 readers were connected") == 2


def test_soak(capsys: pytest.CaptureFixture[str]) -> None:
    assert soak(4.0) == 0, capsys.readouterr().out
