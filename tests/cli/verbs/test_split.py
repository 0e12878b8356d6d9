"""`yarpy split`."""

import sys

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.verbs.split import part


def test_each_element_has_a_port(cli, names):
    with (
        yarpy.Port("/split/source", names=names) as source,
        yarpy.BufferedPort("/split/first", strict=True, names=names) as first,
        yarpy.BufferedPort("/split/second", strict=True, names=names) as second,
        cli.start("split", "/split/source", "--carrier", "tcp") as process,
    ):
        assert source.wait_for_outputs(timeout=HANG)
        source.write([1])
        process.wait_line("^Output goes to /split/source/split0:o$", stream="out")
        first.listen_to("/split/source/split0:o")
        source.write([2, ["x", "y"]], yarpy.Stamp(3, 1.5))  # longer: one more port
        process.wait_line("^Output goes to /split/source/split1:o$", stream="out")
        second.listen_to("/split/source/split1:o")
        assert first.read(timeout=HANG).value == [2]
        source.write([3, ["z"]], yarpy.Stamp(4, 2.5))
        message = second.read(timeout=HANG)
        assert (message.value, message.stamp) == (["z"], yarpy.Stamp(4, 2.5))
        process.stop()
    if sys.platform != "win32":  # nobody asks a program to end there: it is ended
        assert names.query("/split/source/split1:o") is None


def test_a_source_that_is_not_there(here):
    said = here("split", "/nobody")
    assert said.code == 255 and "error: Failed to connect: " in said.err


@pytest.mark.parametrize(("element", "sent"), [(1, [1]), ("x", ["x"]), ([1, 2], [1, 2]), ([], [])])
def test_part(element, sent):
    assert part(element) == sent
