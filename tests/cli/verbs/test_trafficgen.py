"""`yarpy trafficgen`."""

import click
import pytest

import yarpy
from yarpy.cli.verbs.trafficgen import plan


def test_messages_of_a_size_at_a_period(cli, names):
    words = ("/traffic/a", "--period", "0.05", "--size", "0.001", "--duration", "4")
    with (
        yarpy.BufferedPort("/traffic/sink", strict=True, names=names) as sink,
        cli.start("trafficgen", *words) as process,
    ):
        process.wait_line("active", stream="err")
        sink.listen_to("/traffic/a")
        assert process.wait() == 0
        assert process.stdout == (
            "Starting trafficgen with the following options: period:0.050(s), size:0.001(MB), "
            "duration:4.000(s), bandwidth:0.160(Mb/s)\n"
        )
        assert 5 < sink.waiting <= 80
        assert sink.read().value == ["0" * 1000]
    assert names.query("/traffic/a") is None


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ((None, None, None), (8.0, 1.0, 1.0)),
        ((16.0, None, None), (16.0, 0.5, 1.0)),
        ((None, 0.5, None), (16.0, 0.5, 1.0)),
        ((None, 0.5, 0.25), (4.0, 0.5, 0.25)),
        ((8.0, None, 0.5), (8.0, 0.5, 0.5)),
        ((8.0, 0.5, None), (8.0, 0.5, 0.5)),
    ],
)
def test_plan(given, expected):
    assert plan(*given) == expected


def test_too_much_is_said():
    with pytest.raises(click.UsageError):
        plan(1.0, 1.0, 1.0)


@pytest.mark.parametrize("words", [("--period", "0"), ("--size", "-1"), ("--bandwidth", "x")])
def test_wrong_options(here, words):
    assert here("trafficgen", "/traffic/b", *words).code == 1
