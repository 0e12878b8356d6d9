"""Pictures of maps, as C++ colours them, and cells that pictures mean.

Rules: what is no colour of a map is unknown. Percentages are grey: 254 is free, 0 occupied, 205
unknown.
"""

from __future__ import annotations

from typing import Any, Final

#: Flag -> red, green, blue.
COLOURS: Final = (
    (254, 254, 254),  # free
    (255, 0, 0),  # keep out
    (100, 100, 200),  # temporary obstacle
    (255, 200, 0),  # enlarged obstacle
    (0, 0, 0),  # wall
    (205, 205, 205),  # unknown
)
UNKNOWN: Final = 5
#: What C++ reads of a picture: the colours of obstacles that pass are unknown to it.
_READ: Final = (0, 1, 4, 5)


def coloured(flags: Any) -> Any:
    """Return a picture of cells, (height, width, 3)."""
    import numpy as np

    return np.array(COLOURS, "u1")[np.minimum(flags, UNKNOWN)]


def flags_of(picture: Any) -> Any:
    """Return the cells that a picture means."""
    import numpy as np

    found = np.full(picture.shape[:2], UNKNOWN, "u1")
    for flag in _READ:
        found[(picture == COLOURS[flag]).all(axis=2)] = flag
    return found
