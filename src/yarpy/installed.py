"""Entry points of installed packages, at the price of a look where nobody has any for us.

Rules: they are read by importlib.metadata, whose import and search take as long as all else in the
opening of a port. So it is asked only where a file of entry points names a group of ours: that is a
search for some bytes in small files. Where packages may lie elsewhere than in folders, in an
archive or with a finder of others, it is asked.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from functools import lru_cache
from importlib.machinery import PathFinder
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

OURS: Final = b"[yarpy."  # how a section of ours begins


def entry_points(group: str) -> Iterable[EntryPoint]:
    """Return the entry points of a group of ours, `yarpy.KIND`, of all installed packages."""
    if not (_finders_of_others() or _are_there(tuple(sys.path))):
        return ()
    from importlib import metadata

    return metadata.entry_points(group=group)


def _finders_of_others() -> bool:
    return any(
        hasattr(finder, "find_distributions") and finder is not PathFinder
        for finder in sys.meta_path
    )


@lru_cache(1)
def _are_there(path: tuple[str, ...]) -> bool:
    """Return whether a package in one of these folders may have any."""
    return any(map(_may_have, path))


def _may_have(place: str) -> bool:
    try:
        names = os.listdir(place or ".")
    except NotADirectoryError:
        return True  # an archive: others can read it
    except OSError:
        return False
    infos = (name for name in names if name.lower().endswith((".dist-info", "egg-info")))
    return any(_names_us(os.path.join(place, name, "entry_points.txt")) for name in infos)


def _names_us(path: str) -> bool:
    try:
        with open(path, "rb") as file:
            return OURS in file.read()
    except OSError:
        return False  # it has none
