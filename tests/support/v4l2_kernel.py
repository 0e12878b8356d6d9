"""The kernel of Linux with a camera that is not there: a file with buffers, and what it is asked.

    kernel = Kernel(tmp_path / "video0", {"MJPG": (64, 48)})
    kernel.frames.append(Frame(data))
    ... v4l2.ioctl and v4l2.has_input are kernel.ioctl and kernel.has_input ...

Rules: written from videodev2.h, with ctypes: the layouts of what it is for must not test
themselves.
"""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Final

PAGE: Final = 64 * 1024


class Capability(ctypes.Structure):
    _fields_: ClassVar = [
        ("driver", ctypes.c_char * 16),
        ("card", ctypes.c_char * 32),
        ("bus_info", ctypes.c_char * 32),
        ("version", ctypes.c_uint32),
        ("capabilities", ctypes.c_uint32),
        ("device_caps", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32 * 3),
    ]


class Pixels(ctypes.Structure):
    _fields_: ClassVar = [
        (name, ctypes.c_uint32)
        for name in ("width", "height", "pixelformat", "field", "bytesperline", "sizeimage")
    ]


class FormatUnion(ctypes.Union):
    # Some of its members have pointers, which are aligned to eight bytes.
    _fields_: ClassVar = [("pix", Pixels), ("raw", ctypes.c_uint8 * 200), ("p", ctypes.c_void_p)]


class Format(ctypes.Structure):
    _fields_: ClassVar = [("type", ctypes.c_uint32), ("fmt", FormatUnion)]


class Request(ctypes.Structure):
    _fields_: ClassVar = [
        *((name, ctypes.c_uint32) for name in ("count", "type", "memory", "capabilities")),
        ("flags", ctypes.c_uint8),
        ("reserved", ctypes.c_uint8 * 3),
    ]


class Where(ctypes.Union):
    _fields_: ClassVar = [("offset", ctypes.c_uint32), ("userptr", ctypes.c_ulong)]


class Buffer(ctypes.Structure):
    _fields_: ClassVar = [
        *((name, ctypes.c_uint32) for name in ("index", "type", "bytesused", "flags", "field")),
        ("seconds", ctypes.c_long),
        ("microseconds", ctypes.c_long),
        ("timecode", ctypes.c_uint32 * 4),
        ("sequence", ctypes.c_uint32),
        ("memory", ctypes.c_uint32),
        ("m", Where),
        ("length", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32 * 2),
    ]


def number(letter: int, direction: int, size: int) -> int:
    """The number of a request, as the macros of the kernel make it."""
    return direction << 30 | size << 16 | ord("V") << 8 | letter


WRITES, READS, BOTH = 1, 2, 3


@dataclass
class Frame:
    """What a camera gives; flags and time of its buffer."""

    data: bytes
    flags: int = 0
    seconds: float = 0.0


@dataclass
class Kernel:
    """formats: what the camera has, by the name of its pixels, with the only size of each."""

    path: Path
    formats: dict[str, tuple[int, int]]
    capabilities: int = 0x0400_0001
    line: int = 0
    frames: list[Frame] = field(default_factory=list)
    queued: list[int] = field(default_factory=list)
    streaming: bool = False
    refused: dict[int, OSError] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.path.write_bytes(bytes(4 * PAGE))
        self.requests: dict[int, tuple[Any, Any]] = {
            number(0, READS, ctypes.sizeof(Capability)): (Capability, self._tell),
            number(4, BOTH, ctypes.sizeof(Format)): (Format, self._now),
            number(5, BOTH, ctypes.sizeof(Format)): (Format, self._choose),
            number(8, BOTH, ctypes.sizeof(Request)): (Request, self._buffers),
            number(9, BOTH, ctypes.sizeof(Buffer)): (Buffer, self._query),
            number(15, BOTH, ctypes.sizeof(Buffer)): (Buffer, self._queue),
            number(17, BOTH, ctypes.sizeof(Buffer)): (Buffer, self._dequeue),
            number(18, WRITES, 4): (ctypes.c_int, self._stream),
            number(19, WRITES, 4): (ctypes.c_int, self._stream),
        }

    def ioctl(self, file: int, request: int, data: bytearray) -> None:
        if request in self.refused:
            raise self.refused[request]
        kind, act = self.requests[request]
        assert len(data) == ctypes.sizeof(kind)
        self.file = file
        act(kind.from_buffer(data))

    def has_input(self, file: int, seconds: float) -> bool:
        return self.streaming and bool(self.frames) and bool(self.queued)

    def _tell(self, found: Capability) -> None:
        found.card, found.capabilities = b"Webcam", self.capabilities | 0x8000_0000
        found.device_caps = self.capabilities

    def _now(self, found: Format) -> None:
        assert found.type == 1
        name, (width, height) = next(iter(self.formats.items()))
        self._put(found, name, width, height)

    def _choose(self, found: Format) -> None:
        wanted = found.fmt.pix.pixelformat.to_bytes(4, "little").decode()
        self.asked.append(f"{wanted} {found.fmt.pix.width}x{found.fmt.pix.height}")
        name = wanted if wanted in self.formats else next(iter(self.formats))
        self._put(found, name, *self.formats[name])

    def _put(self, found: Format, name: str, width: int, height: int) -> None:
        pix = found.fmt.pix
        pix.width, pix.height = width, height
        pix.pixelformat = int.from_bytes(name.encode(), "little")
        pix.bytesperline, pix.sizeimage = self.line, PAGE

    def _buffers(self, found: Request) -> None:
        assert (found.type, found.memory) == (1, 1)
        found.count = min(found.count, 3)  # it may give fewer

    def _query(self, found: Buffer) -> None:
        assert (found.type, found.memory) == (1, 1)
        found.length, found.m.offset = PAGE, found.index * PAGE

    def _queue(self, found: Buffer) -> None:
        assert (found.type, found.memory) == (1, 1)
        assert found.index not in self.queued
        self.queued.append(found.index)

    def _dequeue(self, found: Buffer) -> None:
        frame, found.index = self.frames.pop(0), self.queued.pop(0)
        os.pwrite(self.file, frame.data, found.index * PAGE)
        found.bytesused, found.flags = len(frame.data), frame.flags
        found.seconds, rest = divmod(round(frame.seconds * 1e6), 1_000_000)
        found.microseconds = rest

    def _stream(self, found: ctypes.c_int) -> None:
        assert found.value == 1
        self.streaming = not self.streaming
