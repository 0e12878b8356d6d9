"""The room that a disk has left, and sizes as people write them.

Rules: at 10 % a recorder says so, at 2 % it stops, cleanly: a full disk stops other programs, too.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, Protocol, TypeAlias

from yarpy.errors import LocalProtocolError

LOW: Final = 0.10
FULL: Final = 0.02

State: TypeAlias = Literal["", "low", "full"]


class Usage(Protocol):
    """A disk: bytes in all, and those that are free."""

    @property
    def total(self) -> int: ...
    @property
    def free(self) -> int: ...


class DiskSpace:
    """The disk of the folder `where`. `usage` asks the system."""

    def __init__(self, where: Path, usage: Callable[[Path], Usage] = shutil.disk_usage) -> None:
        self._where = where
        self._usage = usage
        self.free = 0  # bytes
        self.state: State = ""

    def look(self) -> State:
        """Ask how much is free; what to make of it. A disk that says nothing is taken to have
        room."""
        try:
            found = self._usage(self._where)
        except OSError:
            return self.state
        self.free = found.free
        share = found.free / found.total if found.total else 1.0
        self.state = "full" if share <= FULL else "low" if share <= LOW else ""
        return self.state


@dataclass(frozen=True)
class Split:
    """The limits after which a recording goes on in a new file: so many `bytes` or `seconds`, 0 for
    never."""

    bytes: int = 0
    seconds: float = 0.0


_UNITS: Final = {"": 1, "b": 1, "k": 10**3, "m": 10**6, "g": 10**9, "t": 10**12}
_BINARY: Final = {"ki": 1 << 10, "mi": 1 << 20, "gi": 1 << 30, "ti": 1 << 40}
_TIMES: Final = {"s": 1, "min": 60, "h": 3600}
_NUMBER: Final = re.compile(r"(\d{1,15}(?:\.\d{1,6})?)\s*([a-z]*)", re.ASCII)


def parse_size(text: str) -> int:
    """Return the bytes of `256MB`, `1.5 GiB`, `4096`. Raises LocalProtocolError.

    >>> parse_size("256MB"), parse_size("1KiB")
    (256000000, 1024)
    """
    match = _NUMBER.fullmatch(text.strip().lower())
    if match is not None:
        unit = match[2].removesuffix("b") if match[2] != "b" else ""
        factor = _UNITS.get(unit) or _BINARY.get(unit)
        if factor is not None and float(match[1]) * factor >= 1:
            return round(float(match[1]) * factor)
    raise LocalProtocolError(f'"{text}" is no size: 256MB, 1GiB, 4096')


def parse_split(text: str) -> Split:
    """Return what `1GB` or `10min` says. Raises LocalProtocolError.

    >>> parse_split("10min")
    Split(bytes=0, seconds=600.0)
    """
    match = _NUMBER.fullmatch(text.strip().lower())
    if match is not None and match[2] in _TIMES and float(match[1]) > 0:
        return Split(seconds=float(match[1]) * _TIMES[match[2]])
    try:
        return Split(bytes=parse_size(text))
    except LocalProtocolError:
        raise LocalProtocolError(
            f'"{text}" is no size or time after which a new file begins: 1GB, 500MB, 10min, 30s'
        ) from None


def parse_time(text: str) -> float:
    """Return the seconds of `30`, `30s`, `5min`. Raises LocalProtocolError.

    >>> parse_time("5min"), parse_time("30")
    (300.0, 30.0)
    """
    match = _NUMBER.fullmatch(text.strip().lower())
    factor = None if match is None else 1 if not match[2] else _TIMES.get(match[2])
    if match is None or factor is None or float(match[1]) * factor <= 0:
        raise LocalProtocolError(f'"{text}" is no time: 30s, 5min')
    return float(match[1]) * factor


def size_text(count: float) -> str:
    """Return a number of bytes as people read it.

    >>> size_text(1234567)
    '1.23 MB'
    """
    for unit in ("B", "kB", "MB", "GB"):
        if count < 999.5:
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} TB" if count < 999.5 else f"{count:.0f} TB"
