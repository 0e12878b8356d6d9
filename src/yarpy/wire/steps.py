"""Steps: what a protocol is written in, a generator that asks for bytes or for something else.

Rules: this file imports neither streams nor effects, so that the stream may be written in steps and
an effect may name a stream. `None` asks for more bytes, an `Effect` (see `effects.py`) for
something that only the driver can do; its answer is what the `yield` returns.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")


class Effect:
    """A request of a protocol to its driver, for something besides bytes."""

    __slots__ = ()


Steps: TypeAlias = Generator[Effect | None, Any, T]
