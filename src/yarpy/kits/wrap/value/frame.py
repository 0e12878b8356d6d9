"""Frames: any Python value as a header in JSON and its arrays as they lie in memory.

    header     {"yarpy": 1, "tree": ..., "buffers": [["<f4", [2, 3], "C"], ...],
                "count": 7, "time": 12.5, "source": "/eyes"}
    as one     b"\\x93yarpy1\\n", length of the header (u32, little-endian), the header, and each
               buffer, beginning at a multiple of 8
    as parts   the header and each buffer by itself (ZeroMQ, YARP)

Rules: arrays are not copied where they are contiguous, and are views of what was received. Lengths
are compared with the bytes that are there. The tree is that of `tree.py`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from struct import Struct
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import DecodeError, Truncated
from yarpy.kits.wrap.value.npy import counted
from yarpy.kits.wrap.value.tree import Buffer, TreeEncoder, decode_tree
from yarpy.limit import FRAME_BUFFERS, check_json

if TYPE_CHECKING:
    from numpy.typing import NDArray

MAGIC: Final = b"\x93yarpy1\n"
_LENGTH = Struct("<I")
_DTYPE = re.compile(r"[<>|=][biufcmMSUV]\d{1,9}(?:\[[a-zA-Z]{1,2}\])?")


@dataclass(slots=True)
class Frame:
    """The contents of a frame. `count` and `time` (seconds) are those of the message, None if it
    has none; `source` names its sender."""

    value: Any
    count: int | None = None
    time: float | None = None
    source: str = ""


def to_parts(frame: Frame) -> list[Buffer]:
    """The header, and every buffer. Raises TypeError, ValueError for what cannot be sent."""
    arrays: list[NDArray[Any]] = []
    header: dict[str, Any] = {"yarpy": 1, "tree": TreeEncoder(arrays).encode(frame.value)}
    blocks: list[Buffer] = []
    if arrays:
        if len(arrays) > FRAME_BUFFERS:
            raise ValueError(f"a value with more than {FRAME_BUFFERS} arrays; make one of them")
        laid = [_laid(array) for array in arrays]
        header["buffers"] = [[a.dtype.str, a.shape, order] for a, order, _ in laid]
        blocks = [data for _, _, data in laid]
    if frame.count is not None:
        header["count"] = frame.count
    if frame.time is not None:
        header["time"] = frame.time
    if frame.source:
        header["source"] = frame.source
    return [json.dumps(header).encode(), *blocks]


def _laid(array: NDArray[Any]) -> tuple[NDArray[Any], str, Buffer]:
    """The array, its order, and its memory; a copy if that has gaps."""
    import numpy as np

    if not array.size:
        return array, "C", b""
    if array.flags.c_contiguous:
        return array, "C", _memory(array)
    if array.flags.f_contiguous:
        return array, "F", _memory(array.T)
    whole = np.ascontiguousarray(array)
    return whole, "C", _memory(whole)


def _memory(array: NDArray[Any]) -> memoryview:
    # As bytes, since numpy shows the memory of dates in no other way.
    return array.reshape(-1).view("u1").data


def from_parts(parts: Sequence[Buffer]) -> Frame:
    """The frame of a header and its buffers. Raises DecodeError."""
    header = _header(parts[0]) if parts else {}
    kinds = _kinds(header)
    if len(kinds) != len(parts) - 1:
        raise DecodeError(f"the frame announces {len(kinds)} arrays, and has {len(parts) - 1}")
    return _frame(header, [_array(k, d) for k, d in zip(kinds, parts[1:], strict=True)])


def to_bytes(frame: Frame) -> list[Buffer]:
    """The frame as one message, in pieces to be sent one after the other."""
    header, *blocks = to_parts(frame)
    pieces: list[Buffer] = [MAGIC + _LENGTH.pack(len(header)) + bytes(header)]
    place = len(pieces[0])
    for block in blocks:
        gap = -place % 8
        if gap:
            pieces.append(bytes(gap))
        pieces.append(block)
        place += gap + len(block)
    return pieces


def is_frame(data: Buffer) -> bool:
    """Return whether these bytes begin as a frame."""
    return bytes(data[: len(MAGIC)]) == MAGIC


def from_bytes(data: Buffer) -> Frame:
    """The frame of one message; its arrays are views of `data`. Raises DecodeError, Truncated."""
    view = memoryview(data)
    place = len(MAGIC) + _LENGTH.size
    if len(view) < place or not is_frame(view):
        raise DecodeError("not a frame: it does not begin as one")
    (length,) = _LENGTH.unpack_from(view, len(MAGIC))
    if len(view) - place < length:
        raise Truncated(f"the header takes {length} bytes, here are {len(view) - place}")
    header = _header(view[place : place + length])
    place += length
    arrays = []
    for kind in _kinds(header):
        place += -place % 8
        array = _array(kind, view[place:], whole=False)
        arrays.append(array)
        place += array.nbytes
    if place < len(view):
        raise DecodeError(f"{len(view) - place} bytes behind the end of the frame")
    return _frame(header, arrays)


def _header(text: Buffer) -> dict[str, Any]:
    """The header, its tree as it is: that needs the buffers which the header tells of."""
    text = bytes(text)
    check_json(text)
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"the header of the frame is no JSON: {error}") from error
    if not isinstance(found, dict) or found.get("yarpy") != 1 or "tree" not in found:
        raise DecodeError("the header of the frame is not one of version 1")
    return found


def _kinds(header: dict[str, Any]) -> list[Any]:
    kinds = header.get("buffers", [])
    if not isinstance(kinds, list) or len(kinds) > FRAME_BUFFERS:
        raise DecodeError(f"a frame with more than {FRAME_BUFFERS} arrays, or with no list of them")
    return kinds


def _array(kind: Any, data: Buffer, whole: bool = True) -> NDArray[Any]:
    import numpy as np

    try:
        name, shape, order = kind
        if not _DTYPE.fullmatch(name) or order not in ("C", "F"):
            raise ValueError(f"{name!r} in order {order!r}")
        dtype = np.dtype(name)
        count = counted(shape, dtype)
        size = count * dtype.itemsize
        if len(data) < size or (whole and len(data) != size):
            raise Truncated(f"an array takes {size} bytes, here are {len(data)}", size)
        if not size:
            return np.empty(shape, dtype)
        return np.frombuffer(data, dtype, count).reshape(shape, order=order)
    except DecodeError:
        raise
    except (ValueError, TypeError, OverflowError, MemoryError) as error:
        raise DecodeError(f"the frame has an array that there is none of: {error}") from error


def _frame(header: dict[str, Any], arrays: list[NDArray[Any]]) -> Frame:
    tree = decode_tree(header["tree"], arrays)
    count, time, source = header.get("count"), header.get("time"), header.get("source", "")
    return Frame(
        tree,
        count if isinstance(count, int) else None,
        float(time) if isinstance(time, (int, float)) else None,
        source if isinstance(source, str) else "",
    )
