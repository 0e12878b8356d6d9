"""Querier: how a service of ROS 2 is asked over Zenoh.

Rules: a server is seen by its token, which may come before the routers know the way to it. A
question that is put too early finds nobody, as if the server had gone: who is seen is waited for.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.peers.ros2.key import Key

ANSWER: Final = 600.0  # seconds for an answer, as ROS 2
ROUTED: Final = 5.0  # seconds for the way to a server that is seen
_LOOK: Final = 0.005  # seconds between two looks for it


class Querier:
    """Asks what has a key, as long as `session` is open."""

    def __init__(self, session: Any, key: Key) -> None:
        import zenoh

        self._querier: Any = session.declare_querier(
            str(key),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=ANSWER,
        )

    def get(
        self,
        heard: Callable[[Any], object],
        over: Callable[[], object],
        payload: bytes,
        attachment: bytes,
        served: bool,
    ) -> None:
        """Ask; `heard` gets each reply and `over` is called at the end, both in a thread of Zenoh.
        With `served` somebody is there to answer."""
        from zenoh.handlers import Callback

        if served:
            self._wait()
        self._querier.get(
            Callback(heard, over, indirect=False), payload=payload, attachment=attachment
        )

    def _wait(self) -> None:
        """Return when a question has a way to its server, or as if."""
        until = time.monotonic() + ROUTED
        while not self._querier.matching_status.matching and time.monotonic() < until:
            time.sleep(_LOOK)

    def undeclare(self) -> None:
        """Ask no more."""
        self._querier.undeclare()
