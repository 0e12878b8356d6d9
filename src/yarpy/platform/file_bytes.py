"""Bytes of open files: many pieces of memory into one, without one copy of all, and those at a
place, for threads that share a file.

                    write                             read_at
    Linux, macOS    many pieces in one system call    a call that has the place
    Windows         one piece in each                 to the place, and then the bytes; meanwhile no
                                                      other thread

Rules: the system may take less than it is given; whoever writes goes on where it stopped.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence
from typing import Final

#: pieces that one write may take
MOST: Final = 1 if sys.platform == "win32" else 512

if sys.platform == "win32":
    import threading

    _PLACED: Final = threading.Lock()  # held from the place to the bytes, of any file

    def write(file: io.FileIO, pieces: Sequence[memoryview]) -> int:
        """Return how many bytes of the first pieces the system took. Raises OSError."""
        return file.write(pieces[0]) or 0

    def read_at(handle: int, count: int, place: int) -> bytes:
        """Return the bytes there, fewer where the file ends. Raises OSError."""
        with _PLACED:
            os.lseek(handle, place, os.SEEK_SET)
            return os.read(handle, count)

else:

    def write(file: io.FileIO, pieces: Sequence[memoryview]) -> int:
        """Return how many bytes of the first pieces the system took. Raises OSError."""
        return os.writev(file.fileno(), pieces[:MOST])

    def read_at(handle: int, count: int, place: int) -> bytes:
        """Return the bytes there, fewer where the file ends. Raises OSError."""
        data = os.pread(handle, count, place)
        while len(data) < count and (
            more := os.pread(handle, count - len(data), place + len(data))
        ):
            data += more  # a system call gives at most 2 GiB
        return data
