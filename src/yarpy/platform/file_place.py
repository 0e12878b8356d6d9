"""Putting a file in the place of another one, and taking one away, while others read it.

    Linux, macOS    in one step, at any time
    Windows         not while another program has the file open: it is tried again, for a moment

Rules: who reads a file of ours has it open for that moment alone; one that is open for longer is an
error.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

MOMENT: Final = 2.0  # seconds
_PAUSE: Final = 0.005  # seconds between two tries


def replace(draft: Path, path: Path) -> None:
    """Put `draft` at `path`, in the place of a file that may be there. Raises OSError."""
    _tried(lambda: draft.replace(path))


def remove(path: Path) -> None:
    """Take a file away, if it is there. Raises OSError."""
    _tried(lambda: path.unlink(missing_ok=True))


def _tried(act: Callable[[], object]) -> None:
    if sys.platform == "win32":
        until = time.monotonic() + MOMENT
        while time.monotonic() < until:
            with suppress(PermissionError):  # others have it open, or nobody may
                act()
                return
            time.sleep(_PAUSE)
    act()
