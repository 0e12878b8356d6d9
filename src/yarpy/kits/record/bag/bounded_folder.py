"""A bag of ROS 2, a folder, that the library reads within bounds.

Rules: the library unpacks whatever is packed, and makes of a database what its tables say, which
may be computed: here a message, or a chunk of them, has RECORDED_CHUNK bytes at most, a database
has a limited number of steps until it is open, and files that are packed as a whole unpack to no
more than half of the disk that they go to. What does so are copies of the library's modules that
belong to this one: the library as others in the program use it stays as it is.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any, Final

from yarpy.bounded_file import limited
from yarpy.errors import DecodeError
from yarpy.limit import RECORDED_CHUNK, ROS_BAG_METADATA

STEPS: Final = 10_000_000  # of a database, until it is open; and
STEPS_PER_BYTE: Final = 10  # of its file
_LOOK: Final = 100_000  # steps from one count of them to the next


def open_folder(path: Path) -> Any:
    """Return the library's reader of a bag, open. Raises DecodeError for what is beyond bounds,
    and what the library raises."""
    size = (path / "metadata.yaml").stat().st_size
    if size > ROS_BAG_METADATA:
        raise DecodeError(f"metadata.yaml has {size} bytes, {ROS_BAG_METADATA} at most are read")
    reader = _library().Reader(path)
    reader.open()
    for storage in reader.storage.storages:
        database = getattr(storage, "dbconn", None)
        if database is not None:
            database.set_progress_handler(None)  # reading takes as long as there are messages
    return reader


@cache
def _library() -> Any:
    """Return the library's module of readers, as a copy that is bounded."""
    reader = _copy("reader")
    mcap, sqlite = _copy("storage_mcap"), _copy("storage_sqlite3")
    mcap.DECOMPRESSORS = {
        "": lambda data, size: data,
        "lz4": lambda data, size: _from_lz4(data),
        "zstd": lambda data, size: _from_zstd(reader.zstd.library, data),
    }
    whole_read = mcap.read_exact
    mcap.read_exact = lambda file, size: whole_read(file, _checked(size))
    sqlite.apsw = _bounded_database(sqlite.apsw)
    library = reader.zstd
    reader.zstd = SimpleNamespace(
        library=library,
        decompress=lambda data: _from_zstd(library, data),
        open=lambda file, mode: _Unpacked(library.open(file, mode)),
    )
    plugins = {"mcap": mcap.McapReader, "sqlite3": sqlite.Sqlite3Reader}
    reader.DirectoryReader.STORAGE_PLUGINS = plugins
    return reader


def _copy(name: str) -> Any:
    spec = importlib.util.find_spec(f"rosbags.rosbag2.{name}")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _checked(size: int) -> int:
    if size > RECORDED_CHUNK:
        raise DecodeError(f"a part has {size} bytes, it says: {RECORDED_CHUNK} at most are read")
    return size


def _from_lz4(data: bytes) -> bytes:
    from lz4.frame import LZ4FrameDecompressor

    return limited(LZ4FrameDecompressor(), data, RECORDED_CHUNK)


def _from_zstd(library: Any, data: bytes) -> bytes:
    return limited(library.ZstdDecompressor(), data, RECORDED_CHUNK)


class _Unpacked:
    """A packed file that is read; what comes out is counted."""

    def __init__(self, file: Any) -> None:
        self._file = file
        self._left = shutil.disk_usage(tempfile.gettempdir()).free // 2

    def read(self, size: int) -> bytes:
        data: bytes = self._file.read(size)
        self._left -= len(data)
        if self._left < 0:
            raise DecodeError(
                f"it unpacks to more than half of what is free in {tempfile.gettempdir()}: "
                "name another folder with TMPDIR"
            )
        return data

    def __enter__(self) -> _Unpacked:
        return self

    def __exit__(self, *details: object) -> None:
        self._file.close()


def _bounded_database(library: Any) -> ModuleType:
    """Return the module of the database, whose connections are bounded."""
    found = ModuleType(library.__name__)
    found.__dict__.update(library.__dict__)

    def connection(name: str, **options: Any) -> Any:
        made = library.Connection(name, **options)
        made.limit(library.SQLITE_LIMIT_LENGTH, RECORDED_CHUNK)
        file = made.db_filename("main")
        left = STEPS + STEPS_PER_BYTE * (os.path.getsize(file) if os.path.exists(file) else 0)

        def over() -> bool:
            nonlocal left
            left -= _LOOK
            return left < 0

        made.set_progress_handler(over, _LOOK)
        return made

    found.__dict__["Connection"] = connection
    return found
