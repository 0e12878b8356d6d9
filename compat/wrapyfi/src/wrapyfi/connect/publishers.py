"""The part that publishers of all middlewares share."""

from __future__ import annotations

from typing import Any, ClassVar

from wrapyfi.connect._registry import Registry


class Publishers(Registry):
    """The classes that publish, by type and middleware."""

    registry: ClassVar[dict[str, Any]] = {}
    mwares: ClassVar[set[str]] = set()
    folder = "publishers"


class Publisher:
    """Publishes one value. Subclasses have `establish`, `publish` and `close`."""

    def __init__(
        self, name: str, out_topic: str, carrier: str = "", should_wait: bool = True, **kwargs: Any
    ) -> None:
        self.__name__ = name
        self.out_topic = out_topic
        self.carrier = carrier
        self.should_wait = should_wait
        self.established = False

    def check_establishment(self, established: bool) -> bool:
        """Remember whether it is established, and return that."""
        self.established = established
        return established

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        raise NotImplementedError

    def publish(self, obj: Any) -> None:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


class PublisherWatchDog:
    """Publishers that wait; kept for middlewares of others, which add theirs."""

    def __init__(self, repeats: int = 10, inner_repeats: int = 10) -> None:
        self.publisher_ring: list[Publisher] = []

    def add_publisher(self, publisher: Publisher) -> None:
        self.publisher_ring.append(publisher)

    def remove_publisher(self, publisher: Publisher) -> None:
        if publisher in self.publisher_ring:
            self.publisher_ring.remove(publisher)

    def scan(self) -> None:
        self.publisher_ring = [one for one in self.publisher_ring if not one.establish(repeats=1)]


@Publishers.register("MMO", "fallback")
class FallbackPublisher(Publisher):
    """Publishes nothing."""

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def publish(self, obj: Any) -> None:
        return None

    def close(self) -> None:
        return None
