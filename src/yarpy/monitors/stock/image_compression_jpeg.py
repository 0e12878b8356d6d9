"""image_compression_jpeg: images as JPEG, compressed at the sender's end. Only in yarpy, not C++.

On the wire: a Bottle of [jpeg], the pixel code of the image (a vocab) and a blob, the JPEG file.
The receiver gets an image of the same pixel code; alpha becomes 255.

Rules: libjpeg-turbo releases the GIL. Pixels that are not colours are refused: JPEG would ruin
depth or Bayer patterns.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message

_CODES = ("mono", "rgb", "rgba", "bgr", "bgra")


class ImageCompressionJpeg:
    """Compresses at the sender's end, decompresses at the receiver's. `quality`: 1 to 100."""

    def __init__(self, place: Place) -> None:
        self._sending = place.sending
        self._limit = place.limit
        self._quality = int(place.number("quality", jpeg.QUALITY, 1, 100))

    def update(self, message: Message) -> Message:
        if self._sending:
            image = picture(message, *_CODES)
            data = jpeg.encode(image, self._quality)
            return message.replaced([Vocab("jpeg"), image.code, data])
        match message.as_(Bottle):
            case ["jpeg", str(code), bytes(data)] if code in _CODES:
                wire = jpeg.decode(data, self._limit)
                made = Image.from_wire(wire)
                if made.code == code:
                    return message.replaced(wire, binary=True)
                return message.replaced(made.converted(code))
        raise DecodeError("this is not a JPEG of image_compression_jpeg: does the sender use it?")

    def parameters(self) -> dict[str, object]:
        return {"quality": self._quality} if self._sending else {}
