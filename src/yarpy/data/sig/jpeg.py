"""JPEG: an Image squeezed into a file, the comment inside it, and where such a file ends.

Rules: no protocol here. Compression is simplejpeg's (libjpeg-turbo), imported when it is first
needed; the settings are those of C++ YARP (4:2:0, baseline), so the bytes are the same. The size of
a picture is checked before memory is taken for its pixels; whatever is wrong with it is a
DecodeError.
"""

from __future__ import annotations

from typing import Final

from yarpy.data.sig.image import QUANTUM, Image
from yarpy.errors import DecodeError
from yarpy.limit import JPEG_SCANS, limits

QUALITY: Final = 75  # of libjpeg, and so of C++ YARP


_HEAD_SIZE: Final = 60  # of an Image on the wire
_SOI: Final = b"\xff\xd8"
_COLOURS: Final = {"mono": "GRAY", "rgb": "RGB", "rgba": "RGBA", "bgr": "BGR", "bgra": "BGRA"}
_APP0 = 0xE0
_COM = 0xFE
_SOS = 0xDA
_EOI = 0xD9
_AT_ONCE: Final = (0xC0, 0xC1)  # frames whose colours may come in one scan, as most do
#: numbers that a pixel has in a file, of all its colours
_NUMBERS: Final = {"Gray": 1.0, "420": 1.5, "411": 1.5, "422": 2.0, "440": 2.0}
_ALONE: Final = frozenset((0x01, 0xD8, *range(0xD0, 0xD8)))  # markers without a length
_MAX_COMMENT: Final = 65533


def encode(image: Image, quality: int = QUALITY) -> bytes:
    """The picture as a JPEG file; `quality` from 1 to 100.

    mono becomes grey, every other pixel type is seen as rgb. ValueError for a picture without
    pixels, larger than 65500 either way, or of a pixel type without colours.
    """
    import simplejpeg

    name = str(image.code)
    if name not in _COLOURS:
        image = image.converted("mono" if name in ("sign", "mo16", "int", "dec") else "rgb")
        name = str(image.code)
    if not (0 < image.width <= 65500 and 0 < image.height <= 65500):
        raise ValueError(f"a JPEG of {image.width} times {image.height} pixels is not possible")
    array = image.array if name != "mono" else image.array[..., None]
    if array.strides[2] != 1 or array.strides[1] != array.shape[2] or array.strides[0] < 0:
        array = array.copy()
    sampling = "420" if name != "mono" else "Gray"
    data: bytes = simplejpeg.encode_jpeg(array, quality, _COLOURS[name], sampling)
    return data


def decode(data: bytes | bytearray | memoryview, limit: int = 1 << 30) -> memoryview:
    """The wire form of the picture (what `Image.from_wire` takes): mono if grey, else rgb.

    DecodeError if it is no JPEG, is damaged or cut off, or has more bytes of pixels than `limit` or
    YARPY_MAX_PICTURE. What comes in several scans is kept until the last, two bytes a number: these
    may be YARPY_MAX_PICTURE too.
    """
    import numpy as np
    import simplejpeg

    try:
        height, width, colours, sampling = simplejpeg.decode_jpeg_header(data)
        depth = 1 if str(colours).lower().startswith("gr") else 3
        row = -(-width * depth // QUANTUM) * QUANTUM
        limit = min(limit, limits().picture)
        if row * height > limit:
            raise DecodeError(
                f"a JPEG of {width} times {height} pixels; the limit is {limit} bytes (the port's, "
                "or YARPY_MAX_PICTURE)"
            )
        if bytes(data).count(b"\xff\xda") > JPEG_SCANS:
            raise DecodeError(f"a JPEG of more than {JPEG_SCANS} scans")
        kept = int(2 * width * height * _NUMBERS.get(sampling, 4.0))
        if kept > limits().picture and not _comes_at_once(data):
            raise DecodeError(
                f"a JPEG of {width} times {height} pixels in several scans: {kept} bytes are kept "
                f"from scan to scan; the limit is {limits().picture} (YARPY_MAX_PICTURE)"
            )
        wire = bytearray(_HEAD_SIZE + row * height)
        pixels = np.ndarray((height, width, depth), "u1", wire, _HEAD_SIZE, (row, depth, 1))
        rows = memoryview(wire)[_HEAD_SIZE:]
        size = width * depth
        simplejpeg.decode_jpeg(data, "GRAY" if depth == 1 else "RGB", buffer=rows[: size * height])
        if row != size:
            _spread(rows, size, row, height)
    except DecodeError:
        raise
    except KeyError as error:  # simplejpeg on a subsampling that is unusual
        raise DecodeError(f"not a readable JPEG: subsampling {error} is not known") from error
    except (ValueError, MemoryError) as error:
        raise DecodeError(f"not a readable JPEG: {error}") from error
    image = Image(pixels if depth == 3 else pixels[..., 0])
    wire[:_HEAD_SIZE] = image.to_wire()[0]
    return memoryview(wire)


def _comes_at_once(data: bytes | bytearray | memoryview) -> bool:
    """Return whether the first scan of a file has all of its colours, so that nothing is kept."""
    at, kind, colours = 2, 0, b""
    while at + 10 <= len(data) and data[at] == 0xFF:
        marker, body = data[at + 1], at + 4
        if marker == _SOS:
            return kind in _AT_ONCE and data[body : body + 1] == colours
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            kind, colours = marker, bytes(data[body + 5 : body + 6])
        at += 2 + int.from_bytes(data[at + 2 : body], "big")
    return False


def _spread(rows: memoryview, size: int, row: int, height: int) -> None:
    """Move rows of `size` bytes that lie close together to where they begin `row` bytes apart."""
    padding = bytes(row - size)
    for number in range(height - 1, -1, -1):
        rows[number * row : number * row + size] = rows[number * size : (number + 1) * size]
        rows[number * row + size : (number + 1) * row] = padding


def comment(data: bytes | bytearray | memoryview) -> str:
    """The first comment of a JPEG file, up to its first control character; "" if it has none."""
    at = 2
    while at + 4 <= len(data) and data[at] == 0xFF and data[at + 1] not in (_SOS, _EOI):
        size = int.from_bytes(data[at + 2 : at + 4], "big")
        if data[at + 1] == _COM:
            text = bytes(data[at + 4 : at + 2 + size]).decode("utf-8", "replace")
            for index, letter in enumerate(text):
                if not letter.isprintable():
                    return text[:index]
            return text
        at += 2 + max(size, 2)
    return ""


def commented(data: bytes, text: bytes) -> bytes:
    """The file with a comment, `text` and a NUL, at the place where C++ YARP has it: behind the
    JFIF header.
    """
    at = 2
    if data[2:3] == b"\xff" and data[3] == _APP0:
        at = 4 + int.from_bytes(data[4:6], "big")
    body = text[: _MAX_COMMENT - 1] + b"\0"
    return data[:at] + b"\xff\xfe" + (len(body) + 2).to_bytes(2, "big") + body + data[at:]


class Extent:
    """Finds the end of a JPEG file that comes without its length, in a buffer that grows.

    It walks from segment to segment, so that a thumbnail inside does not end it.
    """

    def __init__(self) -> None:
        self._at = 0
        self._in_scan = False

    def advance(self, data: bytearray) -> int:
        """Return the byte at which the file ends; 0: not in these bytes; -1: not a JPEG file, or a
        broken one."""
        if self._at == 0:
            if not _SOI.startswith(data[:2]):
                return -1
            self._at = min(len(data), 2) if len(data) >= 2 else 0
        while self._at and self._at + 2 <= len(data):
            if self._in_scan:
                if not self._skip_scan(data):
                    return 0
                continue
            if data[self._at] != 0xFF:
                return -1
            marker = data[self._at + 1]
            if marker == 0xFF:
                self._at += 1
            elif marker == _EOI:
                return self._at + 2
            elif marker in _ALONE:
                self._at += 2
            elif self._at + 4 > len(data):
                return 0
            else:
                size = int.from_bytes(data[self._at + 2 : self._at + 4], "big")
                if size < 2:
                    return -1
                self._at += 2 + size
                self._in_scan = marker == _SOS
        return 0

    def _skip_scan(self, data: bytearray) -> bool:
        """Step over compressed pixels to the next marker; False if it has not come."""
        while True:
            found = data.find(b"\xff", self._at)
            if found < 0 or found + 2 > len(data):
                self._at = found if found >= 0 else len(data)
                return False
            following = data[found + 1]
            if following and not 0xD0 <= following <= 0xD7:
                self._at = found + (following == 0xFF)
                if following != 0xFF:
                    self._in_scan = False
                    return True
            else:
                self._at = found + 2
