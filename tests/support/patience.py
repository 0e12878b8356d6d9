"""How long tests wait for what should happen: longer on a slow or busy machine.

Rules: waiting ends as soon as the thing is there, so patience costs nothing where all is well.
`YARPY_TEST_PATIENCE=4` makes every wait four times as long; what is expected *not* to happen is
waited for as before.
"""

from __future__ import annotations

import os
from typing import Final

FACTOR: Final = float(os.environ.get("YARPY_TEST_PATIENCE") or 1)


def patience(seconds: float) -> float:
    """`seconds` on this machine."""
    return seconds * FACTOR
