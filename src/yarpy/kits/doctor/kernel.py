"""Findings about this computer: what the kernel gives to all programs together."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding

LEAST: Final = 16 << 20  # bytes of shared memory that should be free
SCARCE: Final = 0.05


def find(case: Case) -> Iterator[Finding]:
    """shared-memory."""
    if sys.platform == "win32":
        return  # it has no such folder
    folder = case.shared_memory
    try:
        room = os.statvfs(folder)
    except OSError:
        return  # other systems have no such folder
    free, whole = room.f_bavail * room.f_frsize, room.f_blocks * room.f_frsize
    if not whole or free >= max(LEAST, SCARCE * whole):
        return
    yield Finding(
        "shared-memory",
        "this computer",
        f"{folder} has {free / 1e6:.1f} of {whole / 1e6:.1f} MB left: images and arrays that go "
        "through shared memory find no room",
        f"`ls -lS {folder}` shows what fills it (files of programs that were killed may go); more: "
        f"`sudo mount -o remount,size=1G {folder}`, in a container `docker run --shm-size=1g`",
        "warning",
    )
