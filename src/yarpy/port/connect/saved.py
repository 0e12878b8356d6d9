"""Saved QoS: the priorities and deadlines of connections that broke, for when they are made again.

Rules: a connection that was ended in good order is forgotten. What the system refuses
when it is restored is logged, and remains what was asked for.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from yarpy.errors import YarpError
from yarpy.link.qos import grant
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.qos import NOTHING_ASKED, Qos

log = logger("yarpy.port")

MOST: Final = 1000  # connections that are remembered


class SavedQos:
    """The QoS asked for broken connections of one port. Any thread may call: each method is a
    single change of a dict."""

    def __init__(self) -> None:
        self._asked: dict[tuple[bool, str], Qos] = {}  # by direction and peer

    def keep(self, link: Inbound | Outbound) -> None:
        """Save what was asked for a connection that has broken."""
        wanted = link.wanted or NOTHING_ASKED
        asked = replace(link.asked, deadline=wanted.deadline, rate=wanted.rate, late=wanted.late)
        if asked == NOTHING_ASKED:
            return
        if len(self._asked) >= MOST:
            self._asked.pop(next(iter(self._asked)), None)
        self._asked[_key(link)] = asked

    def give(self, link: Inbound | Outbound) -> None:
        """A connection was made: it gets what the one before it had."""
        asked = self._asked.pop(_key(link), None) if self._asked else None
        if asked is None:
            return
        try:
            grant(link, asked)
        except (YarpError, ValueError) as error:
            log.warning(
                "%s: the connection %s is back without its priority: %s",
                link.route.target if isinstance(link, Inbound) else link.route.source,
                link.route,
                error,
            )


def _key(link: Inbound | Outbound) -> tuple[bool, str]:
    incoming = isinstance(link, Inbound)
    return incoming, link.route.source if incoming else link.route.target
