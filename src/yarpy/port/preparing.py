"""Preparing: arrays that a program fills where its readers look at them.

Rules: they mean the same wherever they lie. Without shared memory, and without room in it, it is
memory of our own, of which a copy is sent.
"""

from __future__ import annotations

import math
from operator import index
from typing import TYPE_CHECKING, Any

from yarpy.errors import LocalProtocolError
from yarpy.transports.shared.arena import Arena, arena_of
from yarpy.transports.shared.sealed import available
from yarpy.transports.shared.shared_array import HEADROOM, shared_array_type
from yarpy.wire.stream import LARGE

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray


class Preparing:
    """The room that a port gives its program to fill."""

    def __init__(self) -> None:
        self._arena: Arena | None = None
        self.begun = False  # there were arrays

    def array(self, name: str, shape: int | tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
        """A new array, for the port called `name`; its contents are undefined. Raises TypeError,
        ValueError as numpy does, and for Python objects, which cannot lie there."""
        import numpy as np

        kind = np.dtype(dtype)
        if kind.hasobject:
            raise TypeError(f"an array of type {kind} holds Python objects, which cannot be sent")
        lengths = tuple(map(index, shape if isinstance(shape, (tuple, list)) else (shape,)))
        if min(lengths, default=0) < 0:
            raise ValueError(f"an array of the shape {lengths} has a negative length")
        size = kind.itemsize * math.prod(lengths)
        shared = None
        if size >= LARGE and available():
            try:
                self._arena = self._arena or arena_of(name)
                shared = self._arena.prepare(size)
            except LocalProtocolError:
                pass  # no descriptor is left
        if shared is None:
            shared = shared_array_type()(HEADROOM + size, "u1")
        self.begun = True
        return np.ndarray(lengths, kind, shared, HEADROOM)

    def end(self) -> None:
        """The port closes."""
        self._arena = None
