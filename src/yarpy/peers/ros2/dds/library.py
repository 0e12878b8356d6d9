"""The library of DDS: whether it is there, who may use it when, and how its objects are deleted.

Rules: it translates the QoS of others, and types, in variables that all threads share. So whatever
asks it who is there, or makes a class of it, does so in `turn`.
"""

from __future__ import annotations

import threading
from typing import Any, Final

from yarpy.errors import UnknownPlugin

turn: Final = threading.RLock()  # what is collected meanwhile may delete something


def load() -> Any:
    """The library. Raises UnknownPlugin if it is not installed."""
    try:
        import cyclonedds.core
    except ImportError as error:
        raise UnknownPlugin(
            f"DDS needs cyclonedds ({error}): `pip install 'yarpy[dds]'`"
        ) from error
    return cyclonedds.core


def delete(entity: Any) -> None:
    """Delete it, now. Left to itself, the library deletes nothing that the garbage collector found
    in a circle of references: it goes on receiving."""
    entity.__del__()
