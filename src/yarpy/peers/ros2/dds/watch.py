"""News of others that come to a topic over DDS, as soon as the library knows.

Rules: those who are there are told of, too. The library's readers of such news are made for the
first topic that is watched; each has its own news, so nobody else takes them away.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy.peers.ros2.dds.library import load, turn
from yarpy.peers.ros2.dds.pump import Pump
from yarpy.peers.ros2.token import PUBLISHER, Token

_BURST: Final = 1000  # news that are taken at a time

Hear = Callable[[Token], None]


class Watch:
    """Tells of publishers and subscribers that come. `token` makes one of what the library tells,
    `seen` finds those who are there."""

    def __init__(
        self,
        dds: Any,
        pump: Pump,
        token: Callable[[Any, str], Token],
        seen: Callable[[str, str], list[Token]],
    ) -> None:
        self._dds, self._pump, self._token, self._seen = dds, pump, token, seen
        self._readers: dict[str, Any] = {}
        self._heard: list[tuple[str, str, Hear]] = []
        self._lock = threading.Lock()

    def add(self, name: str, kind: str, hear: Hear) -> None:
        """Call `hear` with each publisher of a topic, or with SUBSCRIBER each subscriber. In the
        thread of the pump, and here."""
        with self._lock:
            self._heard.append((name, kind, hear))
            if kind not in self._readers:
                self._readers[kind] = self._made(kind)
        for token in self._seen(name, kind):
            hear(token)

    def remove(self, hear: Hear) -> None:
        """Call it no more."""
        with self._lock:
            self._heard = [item for item in self._heard if item[2] != hear]

    def _made(self, kind: str) -> Any:
        from cyclonedds import builtin

        what = f"BuiltinTopicDcps{'Publication' if kind == PUBLISHER else 'Subscription'}"
        made = builtin.BuiltinDataReader(self._dds, getattr(builtin, what))
        made.set_status_mask(load().DDSStatus.DataAvailable)
        self._pump.add(made, lambda: self._take(made, kind))
        return made

    def _take(self, reader: Any, kind: str) -> Callable[[], None] | None:
        with turn:
            found = [item for item in reader.take(N=_BURST) if hasattr(item, "topic_name")]
        return (lambda: self._tell(found, kind)) if found else None

    def _tell(self, samples: list[Any], kind: str) -> None:
        with self._lock:
            heard = [(f"rt{name}", hear) for name, what, hear in self._heard if what == kind]
        for sample in samples:
            for topic, hear in heard:
                if sample.topic_name == topic:
                    hear(self._token(sample, kind))

    def close(self) -> None:
        """Tell of nobody any more. The readers end with the participant."""
        with self._lock:
            readers, self._readers = [*self._readers.values()], {}
        for reader in readers:
            self._pump.remove(reader)
