"""The part that listeners of all middlewares share."""

from __future__ import annotations

from typing import Any, ClassVar

from wrapyfi.connect._registry import Registry


class Listeners(Registry):
    """The classes that listen, by type and middleware."""

    registry: ClassVar[dict[str, Any]] = {}
    mwares: ClassVar[set[str]] = set()
    folder = "listeners"


class Listener:
    """Listens to one value. Subclasses have `establish`, `listen` and `close`."""

    def __init__(
        self, name: str, in_topic: str, carrier: str = "", should_wait: bool = True, **kwargs: Any
    ) -> None:
        self.__name__ = name
        self.in_topic = in_topic
        self.carrier = carrier
        self.should_wait = should_wait
        self.established = False

    def check_establishment(self, established: bool) -> bool:
        """Remember whether it is established, and return that."""
        self.established = established
        return established

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        raise NotImplementedError

    def listen(self) -> Any:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


class ListenerWatchDog:
    """Listeners that wait; kept for middlewares of others, which add theirs."""

    def __init__(self, repeats: int = 10, inner_repeats: int = 10) -> None:
        self.listener_ring: list[Listener] = []

    def add_listener(self, listener: Listener) -> None:
        self.listener_ring.append(listener)

    def remove_listener(self, listener: Listener) -> None:
        if listener in self.listener_ring:
            self.listener_ring.remove(listener)

    def scan(self) -> None:
        self.listener_ring = [one for one in self.listener_ring if not one.establish(repeats=1)]


@Listeners.register("MMO", "fallback")
class FallbackListener(Listener):
    """Hears nothing."""

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def listen(self) -> Any:
        return None

    def close(self) -> None:
        return None
