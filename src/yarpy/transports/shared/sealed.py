"""Files in memory that keep their size: who maps one cannot be killed by its being made shorter.

Rules: nothing has a name, so nothing is left behind by programs that are killed. Linux alone.
"""

from __future__ import annotations

import os
import sys
from typing import Final

from yarpy.transports.descriptor import Descriptor, opened

# fcntl, which not every system has, has names for these.
F_ADD_SEALS: Final = 1033
F_GET_SEALS: Final = 1034
F_SEAL_SHRINK: Final = 2
F_SEAL_GROW: Final = 4
_F_SEAL_FUTURE_WRITE: Final = 16  # since Linux 5.1: only who has mapped it already writes


def available() -> bool:
    """Return whether this system can share such memory: Linux can."""
    return hasattr(os, "memfd_create")


def sealed_memory(name: str, size: int) -> Descriptor:
    """A file in memory that keeps its size. Raises OSError."""
    if sys.platform != "linux":
        raise NotImplementedError
    import fcntl

    file = opened(os.memfd_create, name, os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    os.ftruncate(file.fileno(), size)
    fcntl.fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW)
    return file


def forbid_writing(number: int) -> None:
    """From now on nobody else can map it for writing, where the system can do that."""
    if sys.platform != "linux":
        raise NotImplementedError
    import fcntl

    try:
        fcntl.fcntl(number, F_ADD_SEALS, _F_SEAL_FUTURE_WRITE)
    except OSError:
        pass  # an older Linux: readers are programs of the same user
