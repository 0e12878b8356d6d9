"""What a user sees of a connection."""

from __future__ import annotations

import time

from support.wait import wait_until

from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port


def test_who_over_what_and_how_it_is_doing(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in", "tcp+note.x")
        out.write([1], wait=False)
        in_.read(timeout=5)
        (output,) = out.outputs
        (input_,) = in_.inputs
        for connection in (output, input_):
            assert (connection.source, connection.target) == ("/out", "/in")
            assert connection.carrier == "tcp+note.x"
            assert repr(connection) == "<Connection /out -> /in (tcp+note.x)>"
            stats = connection.stats
            assert stats["messages"] == 1
            assert stats["drops"] == 0
            assert stats["bytes"] > 0
            assert stats["rate"] == 0.0  # after one message there is none
        assert output.name == "/in"
        assert input_.name == "/out"


def test_rate_and_jitter_are_measured(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        for number in range(50):
            out.write([number])
            in_.read(timeout=5)
        for connection in (*out.outputs, *in_.inputs):
            stats = connection.stats
            assert stats["rate"] > 100
            assert 0 < stats["period"] < 0.1
            assert stats["jitter"] >= 0


def test_either_side_may_end_it(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=5)
        out.outputs[0].close()
        assert out.outputs == []
        wait_until(lambda: not in_.inputs)
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=5)
        in_.inputs[0].close()
        wait_until(lambda: not in_.inputs)
        assert out.outputs == []  # its sender was told,
        time.sleep(0.7)
        assert in_.inputs == []  # and does not dial again
