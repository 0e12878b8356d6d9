"""The part that servers of all middlewares share."""

from __future__ import annotations

from typing import Any, ClassVar

from wrapyfi.connect._registry import Registry


class Servers(Registry):
    """The classes that answer, by type and middleware."""

    registry: ClassVar[dict[str, Any]] = {}
    mwares: ClassVar[set[str]] = set()
    folder = "servers"


class Server:
    """Answers with one value. Subclasses have `establish`, `await_request`, `reply` and `close`."""

    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "",
        out_topic_connect: str | None = None,
        **kwargs: Any,
    ) -> None:
        self.__name__ = name
        self.out_topic = out_topic
        self.carrier = carrier
        self.out_topic_connect = out_topic_connect or f"{out_topic}:out"
        self.established = False

    def check_establishment(self, established: bool) -> bool:
        """Remember whether it is established, and return that."""
        self.established = established
        return established

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        raise NotImplementedError

    def await_request(self, *args: Any, **kwargs: Any) -> tuple[list[Any], dict[str, Any]]:
        raise NotImplementedError

    def reply(self, obj: Any) -> None:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


@Servers.register("MMO", "fallback")
class FallbackServer(Server):
    """Is asked nothing."""

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def await_request(self, *args: Any, **kwargs: Any) -> tuple[list[Any], dict[str, Any]]:
        return list(args), kwargs

    def reply(self, obj: Any) -> None:
        return None

    def close(self) -> None:
        return None
