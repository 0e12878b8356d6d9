"""The pictures of a video of a data set, one after the other, by the program ffmpeg.

Rules: what a stranger's file makes ffmpeg do is bounded: it opens that file alone, and no picture
is larger than others may be. It ends with whoever asked for the pictures.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Final

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.record.dumper.picture import read_picture
from yarpy.limit import limits

_SIZE: Final = re.compile(rb"(\d{1,6}) (\d{1,6})\n", re.ASCII)


def pictures(
    path: Path, first: float, count: int, fps: float, grey: bool = False
) -> Iterator[Image]:
    """Yield `count` pictures from that moment of a file on, in seconds. Raises UnknownPlugin
    without ffmpeg; DecodeError if there are fewer, or none that can be read."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise UnknownPlugin("pictures of a data set are videos: install the program ffmpeg")
    if not path.is_file():
        raise DecodeError(f"{path} is not there")
    start = max(0.0, first - 0.5 / fps)  # no rounding skips a picture, or takes one before
    form, pixels = ("pgm", "gray") if grey else ("ppm", "rgb24")
    words = [
        program, "-nostdin", "-loglevel", "error",
        "-f", "mov", "-protocol_whitelist", "file", "-max_pixels", str(limits().picture // 3),
        "-ss", f"{start:.6f}", "-i", f"file:{path.absolute()}",
        "-map", "0:v:0", "-frames:v", str(count), "-fps_mode", "passthrough",
        "-f", "image2pipe", "-c:v", form, "-pix_fmt", pixels, "-",
    ]  # fmt: skip
    with tempfile.TemporaryFile() as said:
        run = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said)
        try:
            assert run.stdout is not None
            for number in range(count):
                data = _next(run.stdout)
                if data is None:
                    run.wait()
                    said.seek(0)
                    why = said.read(500).decode("utf-8", "replace").strip().replace("\n", "; ")
                    raise DecodeError(
                        f"{path} has {number} of {count} pictures from {first:.3f} s on"
                        f"{': ' if why else ''}{why}"
                    )
                yield read_picture(data, path.name, "")
        finally:
            run.kill()
            run.communicate()


def _next(file: IO[bytes]) -> bytes | None:
    """Return the next picture, as a file of its own; None at the end."""
    kind, size, deepest = (file.readline(20) for _ in range(3))
    match = _SIZE.fullmatch(size)
    if kind not in (b"P5\n", b"P6\n") or match is None:
        return None
    length = int(match[1]) * int(match[2]) * (3 if kind == b"P6\n" else 1)
    if length > limits().picture:
        raise DecodeError(f"a picture of {length} bytes (YARPY_MAX_PICTURE)")
    body = file.read(length)
    return kind + size + deepest + body if len(body) == length else None
