"""Actions of a person on the network's page, and how they are taken back.

Rules: one thing at a time, and each says how to undo it. A connection whose carrier cannot be
changed is made again as it was, and one that is made anew keeps its priority and deadline.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final

import yarpy
from yarpy.names.base import NameClient
from yarpy.network import connection, qos
from yarpy.network.pairing import existing
from yarpy.network.rejoining import give_back, rejoin, settings

KEPT: Final = 100  # things that can be taken back

Undo = tuple[str, Callable[[], object]]


class Actions:
    """Connects, disconnects, sets priorities. Every method raises a YarpError that says why not,
    ValueError for a priority that there is not."""

    def __init__(self, names: NameClient) -> None:
        self._names = names
        self._undo: list[Undo] = []
        self._lock = threading.Lock()  # pages act in threads of their own

    @property
    def undo_text(self) -> str:
        """The action that `undo` would take back; "" if there is none."""
        return self._undo[-1][0] if self._undo else ""

    def act(self, words: list[object]) -> str:
        """Do what a page says; what was done, in words."""
        with self._lock:
            match words:
                case ["connect", str(source), str(target), str(carrier)]:
                    return self._connect(source, target, carrier)
                case ["disconnect", str(source), str(target)]:
                    return self._disconnect(source, target)
                case ["carrier", str(source), str(target), str(carrier)]:
                    return self._change(source, target, carrier)
                case ["priority", str(source), str(target), priority, str(packets)]:
                    return self._prioritise(source, target, str(priority), packets)
                case ["deadline", str(source), str(target), str(milliseconds)]:
                    return self._expect(source, target, float(milliseconds or 0) / 1000)
                case ["undo"]:
                    return self._take_back()
        raise yarpy.LocalProtocolError("a page of another version: load it again")

    def _connect(self, source: str, target: str, carrier: str) -> str:
        before = existing(source, target, self._names)
        if before:
            return self._change(source, target, carrier or before)
        found, _ = connection.join(source, target, carrier, names=self._names)
        self._remember(
            f"disconnect {source} → {target}",
            lambda: connection.disconnect(source, target, names=self._names),
        )
        return f"connected {source} → {target} over {found}"

    def _disconnect(self, source: str, target: str) -> str:
        carrier = self._carrier(source, target)
        had = settings(source, target, self._names)
        connection.disconnect(source, target, names=self._names)

        def again() -> None:
            connection.join(source, target, carrier, names=self._names)
            give_back(source, target, had, self._names)

        self._remember(f"connect {source} → {target} again", again)
        return f"disconnected {source} → {target}"

    def _change(self, source: str, target: str, carrier: str) -> str:
        before = self._carrier(source, target)
        if carrier == before:
            return f"{source} → {target} is over {carrier} already"
        rejoin(source, target, carrier, before, names=self._names)
        self._remember(
            f"{source} → {target} over {before} again",
            lambda: rejoin(source, target, before, carrier, names=self._names),
        )
        return f"{source} → {target} is over {carrier} now"

    def _carrier(self, source: str, target: str) -> str:
        found = existing(source, target, self._names)
        if not found:
            raise yarpy.UnknownName(f"{source} → {target} is no connection any more")
        return found

    def _prioritise(self, source: str, target: str, priority: str, packets: str) -> str:
        level = None if priority == "" else int(priority)
        policy = None if level is None else "FIFO" if level else "OTHER"
        wish = yarpy.Qos(policy, level, packets or None)
        if wish == yarpy.Qos():
            raise yarpy.LocalProtocolError("say a priority of the thread, of the packets, or both")
        before = qos.granted(source, target, self._names)
        qos.grant(source, target, sender=wish, receiver=wish, names=self._names)
        self._remember(
            f"the priority of {source} → {target} as before",
            lambda: qos.grant(
                source, target, sender=before[0], receiver=before[1], names=self._names
            ),
        )
        return f"{source} → {target} has another priority"

    def _expect(self, source: str, target: str, deadline: float) -> str:
        before = qos.granted(source, target, self._names)[1].deadline or 0.0

        def set_(seconds: float) -> None:
            qos.grant(source, target, receiver=yarpy.Qos(deadline=seconds), names=self._names)

        set_(deadline)
        self._remember(f"the deadline of {source} → {target} as before", lambda: set_(before))
        said = f"a deadline of {1000 * deadline:g} ms" if deadline else "no deadline"
        return f"{source} → {target} has {said}"

    def _remember(self, text: str, act: Callable[[], object]) -> None:
        self._undo = [*self._undo[1 - KEPT :], (text, act)]

    def _take_back(self) -> str:
        if not self._undo:
            raise yarpy.LocalProtocolError("there is nothing to undo")
        text, act = self._undo.pop()
        act()
        return f"undone: {text}"
