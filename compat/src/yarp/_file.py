"""Pictures and sounds in files: `read(image, "x.ppm")`, `write(sound, "x.wav")`.

Rules: sounds are WAV of 8 or 16 bits when they are read, of 16 when they are written; for others
the result is False, as that of C++ without its libraries for them.
"""

from __future__ import annotations

import io
import wave
from pathlib import Path
from typing import Any

import yarpy
from yarp._image import Image
from yarp._log import say
from yarp._sound import Sound

FORMAT_PPM = 3
FORMAT_PGM = 2


def write(src: Image | Sound, dest: str, format: int = 0) -> bool:
    """Write an image: grey as PGM, colour as PPM, a floating-point one as numbers; a sound as WAV;
    False if the file cannot be written."""
    if isinstance(src, Sound):
        data = write_bytestream(src, Path(dest).suffix)
        try:
            Path(dest).write_bytes(data)
        except OSError:
            return False
        return bool(data)
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
    if isinstance(dest, Sound):
        return read_bytestream(dest, data, len(data), Path(src).suffix)
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


def read_bytestream(data: Sound, bytestream: bytes, streamsize: int, format: str) -> bool:
    """Become the sound of these bytes; `format` is how a file of them would end: ".wav"."""
    if not _known(format):
        return False
    try:
        with wave.open(io.BytesIO(bytes(bytestream)[:streamsize])) as opened:
            channels, width = opened.getnchannels(), opened.getsampwidth()
            frames, frequency = opened.readframes(opened.getnframes()), opened.getframerate()
    except (wave.Error, EOFError) as error:
        say("ERROR", f"|yarp.sig.SoundFile| this is no WAV file: {error}")
        return False
    if width not in (1, 2):
        say("ERROR", f"|yarp.sig.SoundFile| samples have 8 or 16 bits, not {8 * width}")
        return False
    import numpy as np

    kind = "<i2" if width == 2 else "u1"
    samples = np.frombuffer(frames, kind).astype("<i2")
    made = yarpy.Sound(samples.reshape(-1, channels).T, frequency)
    data._take(yarpy.Message("D", b"".join(made.to_wire())))
    return True


def write_bytestream(data: Sound, format: str) -> bytes:
    """Return the bytes of a file that ends with `format`; none, if that is not ".wav"."""
    if not _known(format):
        return b""
    import numpy as np

    samples = np.array([[*one] for one in data._channels], "<i2")
    made = io.BytesIO()
    with wave.open(made, "wb") as opened:
        opened.setnchannels(max(data.getChannels(), 1))
        opened.setsampwidth(2)
        opened.setframerate(data.getFrequency() or 1)
        opened.writeframes(samples.T.tobytes() if samples.size else b"")
    return made.getvalue()


def _known(format: str) -> bool:
    if format.lower() in (".wav", "wav"):
        return True
    say("ERROR", f"|yarp.sig.SoundFile| sounds are read and written as .wav, not as {format!r}")
    return False


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
