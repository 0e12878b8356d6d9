"""When a connection that failed is tried again."""

from __future__ import annotations

import yarpy
from yarpy.port.connect import reconnect
from yarpy.port.connect.lost import CALM, SLOWER, Lost
from yarpy.route import Route


def test_pauses_grow(names: yarpy.LocalNames) -> None:
    """A dead port is dialled at once at first, and then ever more rarely, by chance."""
    with yarpy.Port("/out", names=names) as out:
        item = Lost(out._hub, Route("/out", "/in", "tcp"), incoming=False)
        now, pauses = 0.0, []
        while now < 600.0:
            item.put_off(now)
            pauses.append(item.due - now)
            now = item.due
        assert pauses[0] < 0.2
        for early, late in zip(pauses, pauses[7:], strict=False):
            assert late > min(2 * early, 29.9), "beyond what chance does"
        assert len(pauses) < 60, "in ten minutes"
        assert 30.0 <= pauses[-1] <= 30.0 * SLOWER
        item.pause = reconnect.LOCKED
        for _ in range(3):
            item.put_off(0.0)
            assert item.due >= reconnect.LOCKED, "a camera that locks out is asked no sooner"


def test_a_sender_that_is_back_is_looked_at_soon(names: yarpy.LocalNames) -> None:
    """However rarely it was looked for."""
    with yarpy.Port("/in", names=names) as port:
        item = Lost(port._hub, Route("/out", "/in", "tcp"), incoming=True, since=0.0, pause=30.0)
        assert item.peer == "/out" and not item.is_there()
        assert item.is_calm(CALM), "its program has never ended"
        item.seen_gone, item.back = True, None
        assert not item.is_calm(100.0)
        item.put_off(100.1)
        assert item.due == 100.0 + CALM
        assert item.is_calm(item.due)
        item.put_off(item.due)
        assert item.due >= 130.0
