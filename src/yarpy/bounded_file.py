"""A file that a library reads within bounds.

Rules: a library asks for as many bytes as a file says, and unpacks whatever is packed: here no more
is read than there is, an index that leads to the same place over and over ends, and a part unpacks
to so many bytes at most. `place` is where reading has come to, for whoever tells what is wrong.
"""

from __future__ import annotations

import os
from bz2 import BZ2Decompressor
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO, Final

from yarpy.errors import DecodeError

_LINE: Final = 64  # bytes of the line that a file begins with
_OPENING: Final = 1 << 20  # bytes that may be read beyond the size of the file before messages are


class BoundedFile:
    """The file at `path`, where the library wants a path."""

    def __init__(self, path: Path) -> None:
        self._file: BinaryIO = path.open("rb")
        self._size = os.fstat(self._file.fileno()).st_size
        self._left: int | None = 2 * self._size + _OPENING
        self.place = 0

    def __str__(self) -> str:
        return str(self._file.name)

    def exists(self) -> bool:
        """Return True: it is open."""
        return True

    def open(self, mode: str) -> BoundedFile:
        """Return the file."""
        return self

    def opened(self) -> None:
        """The index was read: from now on as much may be read as messages need."""
        self._left = None

    def read(self, size: int) -> bytes:
        """Return the next bytes, no more than there are."""
        self.place = self._file.tell()
        data = self._file.read(min(size, self._size))
        if self._left is not None:
            self._left -= len(data)
            if self._left < 0:
                raise DecodeError("its index leads to the same place over and over")
        return data

    def readline(self) -> bytes:
        """Return the first line."""
        return self._file.readline(_LINE)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go on from there."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Return where it is."""
        return self._file.tell()

    def close(self) -> None:
        """Close it. Idempotent."""
        self._file.close()


def limited(decompressor: Any, data: bytes, most: int) -> bytes:
    """Return what is packed in data, `most` bytes at most. Raises DecodeError."""
    found: bytes = decompressor.decompress(data, most)
    if not decompressor.eof:
        raise DecodeError(f"a packed part is cut off, or has more than {most} bytes")
    return found


def limited_like(unpack: Callable[..., bytes], most: int) -> Callable[..., bytes]:
    """Return what does as `unpack`, a function of bz2 or lz4, but makes `most` bytes at most; any
    other function itself."""
    match unpack.__module__.partition(".")[0]:
        case "bz2":
            return lambda data: limited(BZ2Decompressor(), data, most)
        case "lz4":
            from lz4.frame import LZ4FrameDecompressor

            return lambda data: limited(LZ4FrameDecompressor(), data, most)
        case _:
            return unpack
