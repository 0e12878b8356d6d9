"""The folder of C++ yarpdatadumper for one port: `info.log`, `data.log`, pictures.

Rules: the type of a folder says how its pictures are stored: `Image` as PGM and PPM, `Image:png`,
`Image:jpg`, `Depth` with `.float` files and `DepthCompressed` with `.floatzip` ones; in a `Bottle`
everything is text. Pictures of floats are `.float` files in all but the last, those with a Bayer
pattern PGM: C++ loses the first and dies of the second. A file that is called .png or .jpg is one.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from io import FileIO
from pathlib import Path
from struct import Struct
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, LocalProtocolError, UnknownPlugin
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.kind import kind_of

Times: TypeAlias = Literal["", "rx", "tx", "tx+rx"]

INFO: Final = "info.log"
DATA: Final = "data.log"
BOTTLE: Final = "Bottle"
#: what the first line of info.log says
TYPES: Final = (BOTTLE, "Image", "Image:jpg", "Image:png", "Depth", "DepthCompressed")
SHAPE: Final = Struct("<QQ")  # of a .float file: height, width
BAYER: Final = frozenset(("grbg", "bggr", "gbrg", "rggb"))
_QUALITY: Final = 100  # of JPEG, as in C++


class Part:
    """The folder of a port, which is there and empty.

    type_: one of TYPES. times: see DumperWriter. events: the first lines about connections.
    """

    def __init__(
        self, folder: Path, type_: str, times: Times = "", events: Sequence[str] = ()
    ) -> None:
        self._folder = folder
        self._type = type_
        self._times = times
        self._number = 0
        self.size = 0
        self._pictures = type_ != BOTTLE
        self.tell(f"Type: {type_};\nStamp: {times or 'rx'};\n{''.join(events)}")
        # Without a buffer: a forked child would write what is in it a second time, at its end.
        self.file: Final = FileIO(folder / DATA, "xb")

    def tell(self, text: str) -> None:
        """Write into info.log."""
        with open(self._folder / INFO, "ab") as file:
            file.write(text.encode("utf-8", "surrogateescape"))

    def add(self, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message. Raises OSError; LocalProtocolError for what cannot be stored;
        UnknownPlugin where a library is missing."""
        picture = kind_of(payload) == "yarp/image"
        try:
            content = self._stored(payload) if picture and self._pictures else _text(payload)
        except (DecodeError, ValueError) as error:
            raise LocalProtocolError(f"a message that C++ cannot record: {error}") from error
        line = memoryview(self._head(envelope, received) + b" " + content + b"\n")
        while line:
            done = self.file.write(line)
            self.size += done
            line = line[done:]
        self._number += 1

    def _head(self, envelope: str, received: int) -> bytes:
        """Return the sequence number and the times of a line."""
        try:
            stamp = Stamp.from_text(envelope) if envelope else Stamp()
        except DecodeError:
            stamp = Stamp()
        count = stamp.count if stamp.valid else -1
        sent = f"{stamp.time if stamp.valid else 0.0:.6f}"
        came = f"{received / SECOND:.6f}"
        if self._times == "tx+rx" or (self._times == "tx" and not stamp.valid):
            times = f"{sent} {came}"
        elif self._times == "rx" or not stamp.valid:
            times = came
        else:
            times = sent
        return f"{count} {times}".encode()

    def _stored(self, payload: bytes | memoryview) -> bytes:
        """Write a picture into a file; return what the log says of it."""
        image = Image.from_wire(payload)
        ending, data = picture_file(image, self._type)
        name = f"{self._number:08}{ending}"
        with open(self._folder / name, "xb") as file:
            self.size += file.write(data)
        return f"{name} [{str(image.code).rstrip()}]".encode()


def picture_file(image: Image, type_: str = "Image") -> tuple[str, bytes]:
    """Return the ending and the bytes of the file of a picture in a folder of that type. Raises
    ValueError if it has none, UnknownPlugin where a library is missing."""
    code = str(image.code)
    if code == "dec":
        head = SHAPE.pack(image.height, image.width)
        numbers = np.ascontiguousarray(image.array, "<f4").tobytes()
        if type_ == "DepthCompressed":
            return ".floatzip", head + zlib.compress(numbers)
        return ".float", head + numbers
    if code in BAYER or (code == "mono" and type_ != "Image:png"):
        return ".pgm", _pnm(b"P5", image, image.array)
    if type_ == "Image:jpg":
        return ".jpg", jpeg.encode(image, _QUALITY)
    if code not in ("mono", "rgb", "bgr", "rgba"):
        image = image.converted("rgb")
    if type_ == "Image:png":
        return ".png", _png(image)
    array = image.array
    if code == "bgr":
        array = array[:, :, ::-1]
    return ".ppm", _pnm(b"P6", image, array[:, :, :3])


def _png(image: Image) -> bytes:
    try:
        import cv2
    except ImportError:
        raise UnknownPlugin('pictures as PNG need OpenCV: pip install "yarpy[vision]"') from None
    from yarpy.data.sig import png

    return png.encode(cv2, image if str(image.code) == "mono" else image.converted("rgb"))


def _pnm(magic: bytes, image: Image, array: Any) -> bytes:
    head = b"%b\n%d %d\n255\n" % (magic, image.width, image.height)
    return head + np.ascontiguousarray(array).tobytes()


def _text(payload: bytes | memoryview) -> bytes:
    return codec.decode_as(payload, Bottle).to_text().encode("utf-8", "surrogateescape")


def type_of(payload: bytes | memoryview) -> str:
    """Return the type of the folder for a port, by its first message."""
    if kind_of(payload) != "yarp/image":
        return BOTTLE
    try:
        return "Depth" if str(Image.from_wire(payload).code) == "dec" else "Image"
    except DecodeError:
        return "Image"


def event(port: str, when: int, word: str) -> str:
    """Return a line of info.log; `when` in nanoseconds since 1970."""
    return f"[{when / SECOND:.6f}] {port} [{word}]\n"
