"""One message to many readers."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

import pytest
from support.outbound import at_work, connected, read_messages

from yarpy.carriers.own.tcp import FastTcp
from yarpy.errors import PortClosed, YarpError
from yarpy.link.ending import Ending, moment
from yarpy.link.send.fan_out import offer_to
from yarpy.link.send.outbound import Outbound
from yarpy.wire.message import Packet

LARGE = ["x" * 20_000_000]


def lose(link: Outbound, error: YarpError) -> None:
    raise AssertionError(f"lost: {error}")


def links(stack: ExitStack, count: int) -> tuple[list[Outbound], list[Any]]:
    pairs = [stack.enter_context(connected(FastTcp)) for _ in range(count)]
    return [link for link, _ in pairs], [far for _, far in pairs]


def test_one_stopped_reader_does_not_hold_the_others() -> None:
    with ExitStack() as stack:
        outputs, far = links(stack, 3)
        with at_work(outputs[0]):
            took = offer_to(outputs, Packet([1]), moment(0.05), lose)
            assert took == outputs[1:]
            assert outputs[0].counter.drops == 1
            for sock in far[1:]:
                read_messages(sock, 1, ack=False)


def test_several_stopped_readers_are_waited_for_until_the_port_ends() -> None:
    with ExitStack() as stack:
        outputs, _ = links(stack, 3)
        ending = Ending()
        for link in outputs:
            link.join(ending, newest=False)
        ending.begin("it is over")
        with pytest.raises(PortClosed, match="it is over"):
            for _ in range(10):
                offer_to(outputs, Packet(LARGE), None, lose)
        for link in outputs:
            assert link.counter.messages + link.counter.drops >= 1, "what began follows by itself"


def test_a_reader_that_has_gone_is_lost_and_the_others_get_theirs() -> None:
    with ExitStack() as stack:
        outputs, far = links(stack, 2)
        outputs[0].close(quit_=False)
        lost = []
        took = offer_to(outputs, Packet([1]), None, lambda link, error: lost.append(link))
        assert (took, lost) == ([outputs[1]], [outputs[0]])
        read_messages(far[1], 1, ack=False)


def test_who_insists_waits_where_the_newest_message_wins() -> None:
    with ExitStack() as stack:
        outputs, _ = links(stack, 2)
        for link in outputs:
            link.join(Ending(), newest=True)
        with at_work(outputs[0]):
            assert offer_to(outputs, Packet([1]), None, lose) == outputs[1:]
            assert outputs[0].counter.replaced == 1
            assert offer_to(outputs, Packet([2]), moment(0.01), lose, insist=True) == outputs[1:]
            assert outputs[0].counter.drops == 1
