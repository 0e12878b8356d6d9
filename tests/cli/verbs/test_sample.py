"""`yarpy sample`."""

import time

import pytest
from support.wait import HANG

import yarpy


def test_drops_and_repeats_at_a_constant_rate(cli, names):
    words = ("--output", "/sample/a", "--rate", "20", "--input", "/sample/source", "--show")
    with (
        yarpy.Port("/sample/source", names=names) as source,
        yarpy.BufferedPort("/sample/sink", strict=True, names=names) as sink,
        cli.start("sample", *words) as process,
    ):
        assert source.wait_for_outputs(timeout=HANG)
        sink.listen_to("/sample/a")
        started = time.monotonic()
        for number in range(50):
            source.write([number], yarpy.Stamp(number, 1.0))
            time.sleep(0.005)
        values = []
        while len(values) < 30 or values[-2].value != [49]:  # the last one comes again
            values.append(sink.read(timeout=HANG))
        passed = time.monotonic() - started
        numbers = [message.value[0] for message in values]
        assert numbers == sorted(numbers)
        assert len(set(numbers)) < 40  # many were dropped
        assert passed > 0.035 * len(values)  # at 20 Hz
        assert values[-1].stamp == yarpy.Stamp(49, 1.0)
        process.wait_line("^49$", stream="out")


@pytest.mark.parametrize(
    "words",
    [
        (),
        ("--output", "/sample/b"),
        ("--output", "/sample/b", "--rate", "1", "--period", "1"),
        ("--output", "/sample/b", "--rate", "0"),
        ("--rate", "1"),
    ],
)
def test_wrong_options(here, words):
    assert here("sample", *words).code == 1


def test_a_source_that_is_not_there(here, names):
    assert here("sample", "--output", "/sample/c", "--rate", "1", "--input", "/nobody").code == 1
    assert names.query("/sample/c") is None
