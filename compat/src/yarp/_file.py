"""Pictures in files: `read(image, "x.ppm")`, `write(image, "x.pgm")`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yarpy
from yarp._image import Image

FORMAT_PPM = 3
FORMAT_PGM = 2


def write(src: Image, dest: str, format: int = 0) -> bool:
    """Write an image: grey as PGM, colour as PPM, a floating-point one as numbers; False if the
    file cannot be written."""
    picture = src._image()
    try:
        if str(picture.code) in ("dec", "int"):
            rows = (" ".join(f"{value:g}" for value in row) for row in picture.array)
            Path(dest).write_text("".join(f"{row}\n" for row in rows), encoding="utf-8")
            return True
        grey = str(picture.code) == "mono" or format == FORMAT_PGM
        found = picture.converted("mono" if grey else "rgb")
        head = f"{'P5' if grey else 'P6'}\n{found.width} {found.height}\n255\n"
        Path(dest).write_bytes(head.encode() + found.array.tobytes())
    except (OSError, ValueError):
        return False
    return True


def read(dest: Any, src: str, format: int = 0) -> bool:
    """Read an image that `write`, or another program, has written; False if that fails."""
    import numpy as np

    try:
        data = Path(src).read_bytes()
    except OSError:
        return False
    try:
        if data[:2] in (b"P5", b"P6"):
            words, rest = _header(data)
            width, height = words[0], words[1]
            shape = (height, width) if data[:2] == b"P5" else (height, width, 3)
            size = width * height * (1 if data[:2] == b"P5" else 3)
            if not 0 < size <= len(rest):
                return False
            picture = yarpy.Image(np.frombuffer(rest[:size], "u1").reshape(shape))
        else:
            lines = data.decode("ascii").split("\n")
            rows = [[float(word) for word in line.split()] for line in lines if line.strip()]
            picture = yarpy.Image(np.array(rows, "<f4"), "dec")
    except ValueError:
        return False
    dest._fill(picture)
    return True


def _header(data: bytes) -> tuple[list[int], bytes]:
    """Width, height and maximum, and the bytes behind them."""
    words: list[int] = []
    at = 2
    while len(words) < 3:
        while data[at : at + 1].isspace():
            at += 1
        if data[at : at + 1] == b"#":
            at = data.index(b"\n", at)
            continue
        end = at
        while data[end : end + 1].isdigit():
            end += 1
        if end == at:
            raise ValueError("no header of a picture")
        words.append(int(data[at:end]))
        at = end
    return words, data[at + 1 :]
