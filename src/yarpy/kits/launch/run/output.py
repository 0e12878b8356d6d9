"""Output: what a program says, read from the file that it writes to.

Rules: a file and no pipe, so that a program goes on when whoever reads has gone, and what it said
meanwhile is read later. What was read is given back to the file system, so that a file stays small
however much is written; of what comes faster than it is read, the oldest is left out and counted. A
line ends at LONGEST bytes.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Final

from yarpy.limit import RUN_BEHIND

LONGEST: Final = 2047  # bytes of a line, as yarprun cuts them
_PIECE: Final = 1 << 16  # bytes read at a time
_TURN: Final = 1 << 20  # bytes read in one turn
_RELEASE: Final = 1 << 20  # bytes that are given back together
_PUNCH: Final = 3  # FALLOC_FL_KEEP_SIZE | FALLOC_FL_PUNCH_HOLE


class Output:
    """The output of one program; `at`: where the last reader was, as `at` told."""

    def __init__(self, path: Path, at: int = 0) -> None:
        self._file = os.open(path, os.O_RDWR)
        self.at = at
        self.lost = 0  # bytes
        self._released = 0
        self._rest = b""

    def read(self, whole: bool = False) -> list[str]:
        """Return the lines that have come, without line ends. whole: also the beginning of one,
        since no more comes."""
        lines: list[bytes] = []
        size = os.fstat(self._file).st_size
        if size < self.at:  # somebody has emptied it
            self.at = self._released = 0
        behind = size - self.at - RUN_BEHIND
        if behind > 0:
            self.lost += behind + len(self._rest)
            self.at, self._rest = self.at + behind, b""
        until = min(size, self.at + _TURN)
        while self.at < until:
            os.lseek(self._file, self.at, os.SEEK_SET)
            piece = os.read(self._file, min(_PIECE, until - self.at))
            if not piece:
                break
            self.at += len(piece)
            *ended, self._rest = (self._rest + piece).split(b"\n")
            for line in ended:
                lines += _cut(line)
            while len(self._rest) >= LONGEST:
                lines.append(self._rest[:LONGEST])
                self._rest = self._rest[LONGEST:]
        if whole and self._rest and self.at >= os.fstat(self._file).st_size:
            lines.append(self._rest)
            self._rest = b""
        self._release()
        return [line.decode("utf-8", "replace").rstrip("\r") for line in lines]

    @property
    def read_so_far(self) -> int:
        """Return where the next reader has to begin to miss nothing."""
        return self.at - len(self._rest)

    def close(self) -> None:
        """Read no more."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _release(self) -> None:
        done = self.read_so_far & ~(_RELEASE - 1)
        if done > self._released:
            _punch()(self._file, self._released, done - self._released)
            self._released = done


def _cut(line: bytes) -> list[bytes]:
    return [line[at : at + LONGEST] for at in range(0, len(line) or 1, LONGEST)]


@cache
def _punch() -> Callable[[int, int, int], None]:
    """Return what gives a part of a file back to the file system, or does nothing where that is not
    known."""
    try:
        call = ctypes.CDLL(None, use_errno=True).fallocate
    except (OSError, AttributeError, TypeError):  # TypeError: Windows
        return lambda file, start, size: None
    call.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_int64, ctypes.c_int64]

    def punch(file: int, start: int, size: int) -> None:
        with suppress(OSError):
            call(file, _PUNCH, start, size)

    return punch
