"""The short form of `make chaos` and `make soak`: everything happens, and its promises hold."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from chaos.experiments import Row, all_of
from chaos.network import Missing
from chaos.soak import soak

pytestmark = pytest.mark.timeout(180)


@pytest.mark.parametrize("experiment", all_of(0.03))
def test_experiment(experiment: Callable[[], Row]) -> None:
    try:
        row = experiment()
    except Missing as missing:
        pytest.skip(str(missing))
    assert row.what
    assert row.times
    assert row.result


def test_soak(capsys: pytest.CaptureFixture[str]) -> None:
    assert soak(4.0) == 0, capsys.readouterr().out
