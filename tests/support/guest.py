"""Which guests are in this checkout: `make alone` runs the core's tests without them."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

from yarpy.facts import Row


def is_here(row: Row) -> bool:
    """Whether the room of a plug-in is there."""
    ring = row.home.partition(".")[0]
    if ring == "core":
        return True
    return find_spec(f"yarpy.{ring}") is not None and find_spec(f"yarpy.{row.home}") is not None


def guest(*names: str, ring: str = "peers") -> None:
    """Skip a test, or a file of tests, that is about a guest (or kit) which is not there."""
    for name in names:
        if find_spec(f"yarpy.{ring}") is None or find_spec(f"yarpy.{ring}.{name}") is None:
            pytest.skip(f"without {ring}/{name} in this copy", allow_module_level=True)
