"""Requests of Thrift seen from outside, for those who watch a connection.

Rules: pure. A request that no service of the interface has is unknown, whatever it says.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.kits.thrift.wire.cursor import spread

#: the name of the service, of the method, and the arguments
Observed = tuple[str, str, Bottle]


class Interface:
    """The services of a module."""

    def __init__(self, module: ModuleType) -> None:
        found = [each for each in vars(module).values() if _is_service(each)]
        self._methods = {name: each.__name__ for each in found for name in each._methods}

    def request(self, data: Buffer) -> Observed | None:
        """Decode a request; None if its method is unknown."""
        try:
            items = Bottle.from_bytes(bytes(spread(data)))
        except DecodeError:
            return None
        name = ""
        for at, item in enumerate(items[:20]):
            if not isinstance(item, str):
                return None
            name = f"{name}_{item}" if at else str(item)
            if name in self._methods:
                return self._methods[name], name, Bottle(items[at + 1 :])
        return None


def read(path: Path) -> Interface:
    """Return what tells the requests of a .thrift file apart. Raises DecodeError, OSError."""
    from yarpy.kits.thrift.library import load

    return Interface(load(path))


def _is_service(value: Any) -> bool:
    return isinstance(value, type) and getattr(value, "_thrift", "") == "service"
