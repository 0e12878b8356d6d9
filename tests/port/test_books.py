"""Sums over connections that have ended: nothing of the books is lost with a connection."""

from __future__ import annotations

import pytest
from support.wait import HANG, wait_until

from yarpy.nameserver.local import LocalNames
from yarpy.network.sampling import flows
from yarpy.network.traffic import read
from yarpy.port.answer.report import report
from yarpy.port.port import BufferedPort, Port


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "unix_stream"])
def test_books_balance_over_broken_connections(carrier: str, names: LocalNames) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", strict=True, names=names) as in_:
        out.connect("/in", carrier)
        taken = dropped = 0
        for number in range(300):
            if number % 100 == 50:
                wait_until(lambda: in_._hub.inputs.links)
                for link in in_._hub.inputs.links:
                    link.driver.transport.interrupt()
                wait_until(lambda: not in_._hub.inputs.links or out.outputs)
            if out.outputs:
                took = out.write([number])
                taken, dropped = taken + took, dropped + 1 - took
            else:
                wait_until(lambda: out.outputs, timeout=HANG)
        out.disconnect("/in")
        wait_until(lambda: not in_.inputs, timeout=HANG)
        books = out.stats.past.outputs
        assert books.messages + books.drops + books.unconfirmed == taken + dropped
        read = 0
        while in_.poll():
            read += 1
        assert books.messages <= read <= books.messages + books.unconfirmed
        assert out.stats.unconnected == 0
        into = in_.stats.past.inputs
        assert into.messages == read
        assert into.drops == 0


def test_what_was_never_read_is_dropped_when_the_port_closes(names: LocalNames) -> None:
    with Port("/out", names=names) as out:
        in_ = BufferedPort("/in", strict=True, names=names)
        out.connect("/in")
        for number in range(20):
            out.write([number])
        out.disconnect("/in")
        wait_until(lambda: in_.waiting == 20 and not in_.inputs)
        in_.close()
        past = in_.stats.past.inputs
        assert (past.messages, past.drops) == (20, 20)


def test_what_is_written_to_nobody_is_counted(names: LocalNames) -> None:
    with BufferedPort("/out", names=names) as out, Port("/in", names=names) as in_:
        for number in range(7):
            assert out.write([number]) == 0
        assert out.stats.unconnected == 7
        out.connect("/in")
        assert out.write([7]) == 1
        in_.read(timeout=HANG)
        assert out.stats.unconnected == 7
        assert read(report(out._hub)[-1])[2].unconnected == 7
        [flow] = [one for one in flows(names) if not one.target]
        assert flow.sender is not None
        assert (flow.source, flow.sender.unconnected, flow.drops) == ("/out", 7, 0)
