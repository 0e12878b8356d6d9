"""The library of DDS: whether it is there, and how its objects are deleted."""

from __future__ import annotations

from typing import Any

from yarpy.errors import UnknownPlugin


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
