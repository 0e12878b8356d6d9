"""Pool: what the topics of this process share, by a key, such as our part in a domain.

Rules: it is opened for its first user and ended by its last one. It is opened under the lock, since
a second one must not be.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from typing import Generic, Protocol, TypeVar


class Shared(Protocol):
    """Something with so many users; only a pool counts them."""

    users: int

    def end(self) -> None:
        """Its last user is gone."""

    def ended(self) -> bool:
        """Return whether it can be used no more, though it has users."""


K = TypeVar("K", bound=Hashable)
S = TypeVar("S", bound=Shared)


class Pool(Generic[K, S]):
    """`begin` opens what there is for a key."""

    def __init__(self, begin: Callable[[K], S]) -> None:
        self._begin = begin
        self._held: dict[K, S] = {}
        self._lock = threading.RLock()

    def take(self, key: K) -> S:
        """Return what there is for a key; `leave` gives it back. Raises as `begin` does."""
        with self._lock:
            found = self._held.get(key)
            if found is None or found.ended():
                found = self._held[key] = self._begin(key)
            found.users += 1
            return found

    def leave(self, shared: S) -> None:
        """One user less; the last one ends it."""
        with self._lock:
            shared.users -= 1
            if shared.users:
                return
            self._held = {key: item for key, item in self._held.items() if item is not shared}
        shared.end()

    def forget(self) -> None:
        """Have nothing, as in a forked process, where the threads of others are gone."""
        self._held, self._lock = {}, threading.RLock()
