"""Name conflicts: two programs of the same name that send to one port, as from two name services.

Rules: a sender whose connection broke dials again, and takes the place of what is left of it: that
is how a connection comes back before anybody has noticed its end. But what it replaces twice within
SOON, and lives each time, is not its own: it is another program's, which dials again, too. Then
whoever is here stays, and the newcomer is told, at each attempt, until it has been silent for LONG.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from yarpy.log import logger

log = logger("yarpy.port")

SOON: Final = 5.0  # seconds
LONG: Final = 90.0  # seconds; more than the longest pause between two attempts to reconnect
MOST: Final = 200  # names


class NameConflicts:
    """Of the port called `name`. Any thread may call."""

    def __init__(self, name: Callable[[], str]) -> None:
        self._name = name
        self._replaced: dict[str, float] = {}  # when a sender that lived was, by its name
        self._refused: dict[str, float] = {}  # when a rival was, last

    def replaced(self, source: str) -> None:
        """A connection of that name, which lived, gives its place to another one."""
        now = time.monotonic()
        if now - self._replaced.get(source, -SOON) < SOON:
            self._refused[source] = now
            log.warning(
                '%s: two programs called "%s" send here, and each takes the place of the other; '
                "from now on the one that is here stays. Give one of them another name",
                self._name(),
                source,
            )
        self._replaced[source] = now
        for known in (self._replaced, self._refused):
            while len(known) > MOST:
                known.pop(next(iter(known)), None)

    def refusal(self, source: str) -> str:
        """Return why a newcomer of that name is not taken while another one is here and lives; ""
        if it is."""
        now = time.monotonic()
        last = self._refused.get(source)
        if last is None:
            return ""
        if now - last > LONG:
            self._refused.pop(source, None)
            return ""
        self._refused[source] = now
        return (
            f'another program called "{source}" sends to "{self._name()}" already: '
            "give one of them another name"
        )
