"""The part that clients of all middlewares share."""

from __future__ import annotations

from typing import Any, ClassVar

from wrapyfi.connect._registry import Registry


class Clients(Registry):
    """The classes that ask, by type and middleware."""

    registry: ClassVar[dict[str, Any]] = {}
    mwares: ClassVar[set[str]] = set()
    folder = "clients"


class Client:
    """Asks for one value. Subclasses have `establish`, `request` and `close`."""

    def __init__(self, name: str, in_topic: str, carrier: str = "", **kwargs: Any) -> None:
        self.__name__ = name
        self.in_topic = in_topic
        self.carrier = carrier
        self.established = False

    def check_establishment(self, established: bool) -> bool:
        """Remember whether it is established, and return that."""
        self.established = established
        return established

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        raise NotImplementedError

    def request(self, *args: Any, **kwargs: Any) -> Any:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


@Clients.register("MMO", "fallback")
class FallbackClient(Client):
    """Gets no answer."""

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def request(self, *args: Any, **kwargs: Any) -> Any:
        return None

    def close(self) -> None:
        return None
