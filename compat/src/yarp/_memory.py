"""Values as the bytes that they are sent as, and back."""

from __future__ import annotations

from typing import Any


def encoded(value: Any) -> bytes:
    """The binary message of an object that ports send."""
    blocks = value.to_wire() if hasattr(value, "to_wire") else (value.to_bytes(),)
    return b"".join(blocks)
