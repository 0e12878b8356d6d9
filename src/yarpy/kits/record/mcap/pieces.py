"""Bytes on their way into a file: small pieces joined, all of them written, chunks compressed.

Rules: large pieces are never copied.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Final

from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.mcap.layout import Bytes
from yarpy.platform import file_bytes

COMPRESSIONS: Final = ("none", "lz4", "zstd")
_SMALL: Final = 4096  # bytes: smaller pieces are joined first


def joined(parts: list[Bytes]) -> list[Bytes]:
    """Return the parts with small neighbours made one: each costs the system as much as a kB."""
    found: list[Bytes] = []
    run: list[Bytes] = []
    for part in parts:
        if len(part) < _SMALL:
            run.append(part)
        else:
            if run:
                found.append(b"".join(run))
                run = []
            found.append(part)
    if run:
        found.append(b"".join(run))
    return found


def write_all(file: io.FileIO, parts: Sequence[Bytes]) -> int:
    """Write all parts one after the other; how many bytes these were."""
    views = [memoryview(part).cast("B") for part in parts if len(part)]
    total, at = sum(map(len, views)), 0
    while at < len(views):
        done = file_bytes.write(file, views[at : at + file_bytes.MOST])
        while at < len(views) and done >= len(views[at]):
            done -= len(views[at])
            at += 1
        if done:
            views[at] = views[at][done:]
    return total


def compressor(name: str) -> Callable[[bytes], bytes] | None:
    """Return what packs a chunk. Raises UnknownPlugin."""
    try:
        if name == "none":
            return None
        if name == "zstd":
            import zstandard

            return zstandard.ZstdCompressor(level=1).compress
        if name == "lz4":
            import lz4.frame

            compress: Callable[[bytes], bytes] = lz4.frame.compress
            return compress
    except ImportError:
        raise UnknownPlugin(
            f'{name} needs a library: pip install "yarpy[record]"; or record with --compress none'
        ) from None
    raise LocalProtocolError(f'no compression "{name}": it is one of {", ".join(COMPRESSIONS)}')
