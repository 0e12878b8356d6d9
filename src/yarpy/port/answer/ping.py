"""Ping: the signs of life that some protocols want of whoever has dialled, such as brokers.

Rules: a ping goes out as often as its carrier says (`limits`), whatever else is said. It never
waits: where something is on its way there, or the peer takes nothing, it is left out until the next
look. The protocol reads what is answered; who says nothing for SILENCE pings is taken for gone, and
the connection ends with a log line: a program that is stopped, or a host that vanished, gives no
other sign. Who owes an acknowledgement, which no ping may come between, is to say something, too.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.hub import Hub

log = logger("yarpy.port")

SILENCE: Final = 2  # times as long as between two pings

Link = Inbound | Outbound


@dataclass(slots=True)
class _Turn:
    """The time of a connection's next ping. `heard`: bytes that had come when the peer was last
    known to be there; `asked`: when the first ping left after that, None if none has."""

    due: float
    heard: int
    asked: float | None = None


class Pings:
    """The times of the next pings, for each connection that wants them."""

    def __init__(self) -> None:
        self._turns: dict[Link, _Turn] = {}

    def look(self, hubs: Iterable[Hub]) -> None:
        """Send what is due, and end the connections of those who do not answer."""
        now = time.monotonic()
        before, self._turns = self._turns, {}
        for hub in hubs:
            links: tuple[Link, ...] = (*hub.inputs.links, *hub.outputs.links)
            for link in links:
                every = link.carrier.limits.ping_interval
                if not every:
                    continue
                turn = before.get(link) or _Turn(now + every, link.driver.bytes_in)
                self._turns[link] = turn
                if turn.asked is not None and _is_there(link, turn.heard):
                    turn.heard, turn.asked = link.driver.bytes_in, None
                if turn.asked is not None and now - turn.asked >= SILENCE * every:
                    del self._turns[link]
                    _end(link, f"it has not answered for {now - turn.asked:.0f} s")
                elif now >= turn.due and (_ping(link) or _owes(link)):
                    turn.due = now + every
                    turn.asked = now if turn.asked is None else turn.asked


def _is_there(link: Link, heard: int) -> bool:
    """Return whether anything has come from the peer; it may not have been read yet, by a thread
    that is busy with a message."""
    driver = link.driver
    return driver.bytes_in != heard or driver.transport.wait_readable(0.0)


def _owes(link: Link) -> bool:
    """Return whether the peer is to acknowledge messages."""
    return isinstance(link, Outbound) and link.sender.window.open > 0


def _end(link: Link, why: str) -> None:
    """End a connection whose peer is gone; its thread, and who writes, find that out."""
    if isinstance(link, Outbound):
        link.sender.reason = why
        log.warning("%s: %s is disconnected: %s", link.route.source, link.route.target, why)
    else:
        link.receiver.incoming.reason = why  # its thread logs it
    link.driver.transport.interrupt()


def _ping(link: Link) -> bool:
    """Send a ping, if that takes no waiting."""
    if isinstance(link, Outbound):
        return link.sender.interject(link.carrier.limits.ping)
    driver = link.driver
    if driver.stream.pending:
        return False  # acknowledgements are on their way: no bytes may come between theirs
    with contextlib.suppress(OSError):  # its thread meets the same end
        driver.transport.try_send([link.carrier.limits.ping])
    return True
