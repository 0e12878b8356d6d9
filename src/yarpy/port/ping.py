"""Ping: the signs of life that some protocols want of whoever has dialled, such as MQTT's brokers.

Rules: a ping goes out once per `ping_interval` of its carrier, whatever else is said. It never
waits: where something is on its way there, or the peer takes nothing, it is left out until the next
look. What is answered, the protocol reads.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable

from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.port.hub import Hub

Link = Inbound | Outbound


class Pings:
    """When each connection that wants pings gets the next one."""

    def __init__(self) -> None:
        self._due: dict[Link, float] = {}

    def look(self, hubs: Iterable[Hub]) -> None:
        """Send what is due."""
        now = time.monotonic()
        before, self._due = self._due, {}
        for hub in hubs:
            links: tuple[Link, ...] = (*hub.inputs, *hub.outputs)
            for link in links:
                every = link.carrier.ping_interval
                if not every:
                    continue
                due = before.get(link, now + every)
                if now >= due and _ping(link):
                    due = now + every
                self._due[link] = due


def _ping(link: Link) -> bool:
    """Send a ping, if that takes no waiting."""
    if isinstance(link, Outbound):
        return link.sender.interject(link.carrier.ping)
    driver = link.driver
    if driver.stream.pending:
        return False  # acknowledgements are on their way: no bytes may come between theirs
    with contextlib.suppress(OSError):  # its thread meets the same end
        driver.transport.try_send([link.carrier.ping])
    return True
