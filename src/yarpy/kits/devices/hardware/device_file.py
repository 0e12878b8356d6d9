"""Files of Linux that stand for what is plugged in: opened, or refused with what to do.

Rules: what is refused keeps its type, FileNotFoundError or PermissionError.
"""

from __future__ import annotations

import os
from pathlib import Path


def open_device(
    path: str, flags: int, what: str, *, others: str, option: str, absent: str, group: str
) -> int:
    """Return the descriptor of a device's file.

    what: the device, in words. others, option: the pattern of its neighbours' names, and the option
    that takes one of them; absent: what to do where there is none. group: whose users may open it.
    Raises OSError.
    """
    try:
        return os.open(path, flags)
    except FileNotFoundError as error:
        there = " ".join(sorted(map(str, Path(path).parent.glob(others))))
        raise FileNotFoundError(
            f"there is no {what} at {path}: "
            + (f"{option} takes one of {there}" if there else absent)
        ) from error
    except PermissionError as error:
        raise PermissionError(
            f"the {what} at {path} is not for this user: sudo usermod -aG {group} $USER, and log "
            "in anew"
        ) from error
