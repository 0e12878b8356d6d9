"""Properties: what others have written down at a port by `prop set`.

Rules: all of them take `limit.PROPERTIES` bytes at most, as a message spells them.
"""

from __future__ import annotations

from typing import Any

from yarpy.data import codec
from yarpy.limit import PROPERTIES


class Properties:
    """The keys and values of one port."""

    def __init__(self) -> None:
        self._values: dict[str, Any] = {}
        self._sizes: dict[str, int] = {}  # bytes of each

    def get(self, key: str) -> Any:
        """Return a value; None if there is none."""
        return self._values.get(key)

    def keep(self, key: str, value: Any) -> bool:
        """Set a property, which stays for as long as the port does; False if it is too large."""
        size = len(b"".join(codec.encode([key, value] if value is not None else [key])))
        if sum(self._sizes.values()) - self._sizes.get(key, 0) + size > PROPERTIES:
            return False
        self._values[key] = value
        self._sizes[key] = size
        return True

    def sorted(self) -> list[tuple[str, Any]]:
        """Return all of them by their keys."""
        return sorted(self._values.items())
