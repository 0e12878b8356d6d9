"""Fan-out: one message to all connections of a port, so that no reader holds up the others.

Rules: every connection is offered the message without waiting; only then those that take it slowly
are waited for, all at once, and the last one by itself.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from yarpy.errors import PortClosed, YarpError
from yarpy.link.ending import NOW
from yarpy.link.send.outbox import Rest
from yarpy.link.send.readiness import wait_for_any
from yarpy.link.send.slow_reader import SOON

if TYPE_CHECKING:
    from yarpy.link.send.outbound import Outbound
    from yarpy.wire.message import Packet

# Seconds between two looks at a reader who seems to take something, and does not.
_SHORTEST: Final = 0.0002
_LONGEST: Final = 0.02

Lose = Callable[["Outbound", YarpError], None]


def offer_to(
    links: Sequence[Outbound],
    packet: Packet,
    until: float | None,
    lose: Lose,
    insist: bool = False,
) -> list[Outbound]:
    """Offer a message to connections, and return those that took it by `until`. `lose` is told of
    those that fail. With `insist` the newest message does not win: it waits for its turn. Raises
    PortClosed."""
    took, slow = begin(links, packet, lose, insist, until if len(links) == 1 else NOW)
    if slow:
        finish(slow, took, until, lose)
    return took


def begin(
    links: Sequence[Outbound],
    packet: Packet,
    lose: Lose,
    insist: bool = False,
    until: float | None = NOW,
) -> tuple[list[Outbound], list[tuple[Outbound, Rest]]]:
    """Offer a message to connections until then; return those that took it, and what is left to
    `finish`. As `offer_to`."""
    took: list[Outbound] = []
    slow: list[tuple[Outbound, Rest]] = []
    for link in links:
        if not link.active or link.log:
            continue
        box = link.reliable if insist else link.box
        try:
            sent = box.offer(packet, until)
        except PortClosed:
            raise
        except YarpError as error:
            lose(link, error)
            continue
        if isinstance(sent, Rest):
            slow.append((link, sent))
        elif sent:
            took.append(link)
    return took, slow


def finish(
    slow: list[tuple[Outbound, Rest]], took: list[Outbound], until: float | None, lose: Lose
) -> None:
    """Wait for slow readers; add to `took` those that take the message by `until`."""
    ending = slow[0][0].sender.ending
    pause, before, told = _SHORTEST, -1, time.monotonic() + SOON
    try:
        while len(slow) > 1 and (wait := ending.slice(until)):
            ready = wait_for_any((link for link, _ in slow), wait)
            sent = sum(link.driver.bytes_out for link, _ in slow)
            if sent != before:
                pause, before = _SHORTEST, sent
            elif ready:  # something else is in the way
                time.sleep(pause)
                pause = min(2 * pause, _LONGEST)
            if told and time.monotonic() > told:
                told = 0.0
                for link, _ in slow:
                    link.sender.slow.warn()
            for item in tuple(slow):
                _offer(item, slow, took, NOW, lose)
        # The last one; or all, since the time is over: it is dropped there, or follows by itself.
        for item in tuple(slow):
            _offer(item, slow, took, until, lose)
    finally:
        for _, rest in slow:  # this writer was interrupted
            rest.leave()


def _offer(
    item: tuple[Outbound, Rest],
    slow: list[tuple[Outbound, Rest]],
    took: list[Outbound],
    until: float | None,
    lose: Lose,
) -> None:
    """Offer what is left to one of the `slow`; it stays there, or goes to `took`, or is gone."""
    link, rest = item
    place = slow.index(item)
    try:
        sent = rest.offer(until)
    except PortClosed:
        del slow[place]  # and it was counted
        raise
    except YarpError as error:
        del slow[place]
        lose(link, error)
        return
    if isinstance(sent, Rest):
        slow[place] = (link, sent)
        return
    del slow[place]
    link.sender.slow.took()
    if sent:
        took.append(link)
