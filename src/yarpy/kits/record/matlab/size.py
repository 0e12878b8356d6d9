"""The memory that a file of MATLAB takes, computed before a library reads it: compressed data may
be a thousand times as long, and dimensions may lie.

Rules: nothing of it is kept. A file that is damaged is left to the library.
"""

from __future__ import annotations

import zlib
from pathlib import Path
from struct import Struct
from typing import IO, Final

from yarpy.errors import DecodeError
from yarpy.limit import MATLAB_FILE

HEAD: Final = 128  # bytes in front of the elements of version 5; its last two are their order
COMPRESSED: Final = 15  # the type of an element that zlib has packed
_TAGS: Final = {b"IM": Struct("<2I"), b"MI": Struct(">2I")}
_HDF5: Final = b"\x89HDF\r\n\x1a\n"  # at 512 bytes, behind a head of MATLAB, or at the beginning
_PIECE: Final = 1 << 16  # bytes at a time


def check_size(path: Path) -> None:
    """See that the values of a file fit into memory. Raises OSError, DecodeError if they do not."""
    with path.open("rb") as file:
        head = file.read(1024)
        if _HDF5 in (head[:8], head[512:520]):
            size = _declared(path)
        elif tag := _TAGS.get(head[HEAD - 2 : HEAD]):
            file.seek(HEAD)
            size = _unpacked(file, tag)
        else:
            return
    if size > MATLAB_FILE:
        raise DecodeError(f"{path}: its values take more than {MATLAB_FILE >> 20} MB of memory")


def _unpacked(file: IO[bytes], tag: Struct) -> int:
    """Return the bytes of all elements, or more than the limit."""
    total = 0
    while total <= MATLAB_FILE and len(head := file.read(tag.size)) == tag.size:
        kind, size = tag.unpack(head)
        if kind == COMPRESSED:
            total += _inflated(file, size, MATLAB_FILE - total)
        else:
            total += size
            file.seek(size, 1)
    return total


def _inflated(file: IO[bytes], size: int, limit: int) -> int:
    """Return the bytes of an element that is packed in `size` bytes, or more than `limit`."""
    packed, total = zlib.decompressobj(), 0
    while size and total <= limit:
        piece = file.read(min(size, _PIECE))
        if not piece:
            break
        size -= len(piece)
        try:
            while piece and total <= limit:
                total += len(packed.decompress(piece, _PIECE))
                piece = packed.unconsumed_tail
        except zlib.error:
            break
    file.seek(size, 1)
    return total


def _declared(path: Path) -> int:
    """Return the bytes of all arrays of a file of HDF5."""
    import h5py

    total = 0

    def add(_: str, item: object) -> None:
        nonlocal total
        if isinstance(item, h5py.Dataset):
            total += int(item.nbytes)

    with h5py.File(path, "r") as file:
        file.visititems(add)
    return total
