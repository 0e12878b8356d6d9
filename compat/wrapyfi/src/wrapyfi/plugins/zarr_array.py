"""Arrays and groups of zarr, as a zip file of their store.

    ["ZarrData", base64 of the zip file, "Array" or "Group", name]

Rules: what comes stays in memory, and can be read as long as it is held (the original reads from a
directory that is gone by then). A store names the codecs by which it is read, and one of them
unpickles: those that are taken are a list.
"""

from __future__ import annotations

import io
import json
import os
import tempfile
import zipfile
from base64 import b64decode, b64encode
from typing import Any, Final

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError
from yarpy.limit import limits

try:
    import zarr

    HAVE_ZARR = True
except ImportError:
    HAVE_ZARR = False

_METADATA: Final = frozenset(("zarr.json", ".zarray", ".zgroup", ".zattrs", ".zmetadata"))
_CODECS: Final = frozenset(
    (
        *("bytes", "transpose", "crc32c", "blosc", "zstd", "gzip", "zlib", "lz4", "bz2", "lzma"),
        *("shuffle", "delta", "fixedscaleoffset", "vlen-utf8", "vlen-bytes", "packbits"),
    )
)


@PluginRegistrar.register(types=(zarr.Array, zarr.Group) if HAVE_ZARR else None)
class ZarrData(Plugin):
    """`zarr.Array`, `zarr.Group`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        out = io.BytesIO()
        with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(out, "w") as file:
            if isinstance(obj, zarr.Group):
                _copy(obj, zarr.open_group(folder, mode="w"))
            else:
                _save(folder, obj)
            for place, _, names in os.walk(folder):
                for name in sorted(names):
                    path = os.path.join(place, name)
                    file.write(path, os.path.relpath(path, folder))
        kind = "Group" if isinstance(obj, zarr.Group) else "Array"
        name = obj.name if kind == "Array" else None
        return True, {"__wrapyfi__": ("ZarrData", b64encode(out.getvalue()).decode(), kind, name)}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_ZARR:
            return False, None
        store = _store(_members(b64decode(obj_full[1], validate=True)))
        read = zarr.open_array if obj_full[2] == "Array" else zarr.open_group
        try:
            return True, read(store, mode="r")
        except (OSError, ValueError, TypeError, LookupError) as error:
            raise DecodeError(f"not a store of zarr: {error}") from error


def _save(folder: str, array: Any) -> None:
    zarr.save_array(folder, array[...])
    if array.attrs:
        zarr.open_array(folder, mode="r+").attrs.update(dict(array.attrs))


def _copy(source: Any, to: Any) -> None:
    """Copy a group with all that is in it."""
    to.attrs.update(dict(source.attrs))
    for name, array in source.arrays():
        made = to.create_array(name, data=array[...])
        made.attrs.update(dict(array.attrs))
    for name, group in source.groups():
        _copy(group, to.create_group(name))


def _members(data: bytes) -> dict[str, bytes]:
    """The files of a store. Raises DecodeError."""
    left = max(limits().unpacked, len(data))
    found = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            for item in file.infolist():
                left -= item.file_size
                if left < 0:
                    raise DecodeError("a store of zarr that is too large (YARPY_MAX_UNPACKED)")
                if not item.is_dir():
                    found[item.filename] = file.read(item)
    except (zipfile.BadZipFile, ValueError, OSError, NotImplementedError, EOFError) as error:
        raise DecodeError(f"not a zip file: {error}") from error
    for name, text in found.items():
        if name.rpartition("/")[2] in _METADATA:
            _check(json.loads(text))
    return found


def _check(tree: Any) -> None:
    """Refuse codecs that are not known. DecodeError."""
    if isinstance(tree, list):
        for item in tree:
            _check(item)
    if not isinstance(tree, dict):
        return
    for key, value in tree.items():
        if key in ("codecs", "compressor", "compressors", "filters", "serializer"):
            for codec in value if isinstance(value, list) else [value]:
                word = codec.get("name", codec.get("id")) if isinstance(codec, dict) else codec
                if word is not None and str(word) not in _CODECS:
                    raise DecodeError(f"a store of zarr by the codec {str(word)[:80]}")
        if key != "attributes":
            _check(value)


def _store(members: dict[str, bytes]) -> Any:
    memory = zarr.storage.MemoryStore
    if hasattr(zarr.storage, "KVStore"):  # zarr 2
        return zarr.storage.KVStore(dict(members))
    from zarr.core.buffer.cpu import Buffer

    return memory({name: Buffer.from_bytes(data) for name, data in members.items()})
