"""Scope: the numbers of ports as curves, in a page that a port serves itself.

    GET /                       the page
    GET /data?after=120,40      messages after number 120 of the first source and 40 of the second

Rules: a page polls for new data as often as it likes, so that a slow browser costs nothing. A
device is asked once what it sends, while its curves are already being drawn.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any, Final

import yarpy
from yarpy.kits.views.asset import jsonpage, site
from yarpy.kits.views.label import learn, rpc_of
from yarpy.kits.views.trace import Trace
from yarpy.names.base import NameClient

SOURCES: Final = 16  # most sources that are drawn


class Scope:
    """Draws what `take` is given; to be the callback of the port that shows the page.

        scope = Scope(["/head/state"])
        with yarpy.Port("/scope", callback=scope.take) as port:
            scope.serve(port)

    names: of the sources that are drawn first, in this order; others follow as they come. indices:
    see Trace. view: what the page begins with: `min`, `max`, `window` (s), each may be None.
    """

    def __init__(
        self,
        names: Sequence[str] = (),
        indices: Sequence[int] = (),
        view: Mapping[str, float | None] | None = None,
    ) -> None:
        self._port: yarpy.Port | None = None
        self._names: NameClient | None = None
        self._asked: set[str] = set()
        self._indices = indices
        self._view = dict(view or {})
        self._start = time.monotonic()
        self._run = f"{time.time():.6f}"  # another one when the program was started again
        self._traces = {name: Trace(name, indices) for name in names}
        self._waiting: dict[str, str] = {}
        self._refused = 0
        self._lock = threading.Lock()  # messages come in threads of their connections

    def serve(self, port: yarpy.Port, names: NameClient | None = None) -> None:
        """Show the page on `port`, and say which ports send there; `names` knows the others."""
        self._port = port
        self._names = names
        pages = site("scope")
        pages["/data"] = self._data
        port.on_page(pages)

    def take(self, message: yarpy.Message) -> None:
        """Draw the numbers of a message."""
        now = self._now()
        with self._lock:
            trace = self._traces.get(message.source)
            if trace is None:
                if len(self._traces) >= SOURCES:
                    self._refused += 1
                    return
                trace = self._traces[message.source] = Trace(message.source, self._indices)
            if message.source not in self._asked:
                self._asked.add(message.source)
                self._ask(trace)
            trace.take(message, now)

    def _ask(self, trace: Trace) -> None:
        """Ask the device behind a port, in the background, for the names of its numbers."""

        def learn_it() -> None:
            found = learn(trace.name, self._names)
            if found is not None:
                with self._lock:
                    trace.describe(found)

        if rpc_of(trace.name):
            name = f"yarpy labels {trace.name}"
            threading.Thread(target=learn_it, name=name, daemon=True).start()

    def wait_for(self, name: str, line: str) -> None:
        """Show why the source `name` is missing; "": it is not."""
        self._waiting[name] = line

    def status(self, after: Sequence[int] = ()) -> dict[str, Any]:
        """Return the state for a page that has so many messages of each source."""
        port = self._port
        carriers = {link.source: link.carrier for link in port.inputs} if port else {}
        known = dict(enumerate(after))
        with self._lock:
            now = self._now()
            told = [
                {**trace.told(known.get(number, 0), now), "carrier": carriers.get(trace.name, "")}
                for number, trace in enumerate(self._traces.values())
            ]
        return {
            "run": self._run,
            "name": port.name if port else "",
            "now": now,
            "view": self._view,
            "sources": told,
            "waiting": [line for line in self._waiting.values() if line],
            "refused": self._refused,
        }

    def _now(self) -> float:
        return time.monotonic() - self._start

    def _data(self, fields: Mapping[str, str]) -> yarpy.Page:
        words = fields.get("after", "").split(",")[:SOURCES]
        return jsonpage(
            self.status([int(word) if word.isdecimal() and len(word) < 16 else 0 for word in words])
        )
