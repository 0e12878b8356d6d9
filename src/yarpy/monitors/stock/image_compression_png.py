"""image_compression_png: images as PNG, compressed at the sender's end without loss.

On the wire: a Bottle of [png], the pixel code of the image (a vocab) and a blob, the PNG file. The
receiver gets the same image. C++ YARP has no such monitor.

Rules: needs OpenCV (extra `vision`), which releases the GIL.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle
from yarpy.data.sig import png
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.monitors.base import Place
from yarpy.monitors.extra import needed
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message


class ImageCompressionPng:
    """Compresses at the sender's end, decompresses at the receiver's."""

    def __init__(self, place: Place) -> None:
        self._sending = place.sending
        self._limit = place.limit
        self._cv2 = needed("cv2", "vision", "image_compression_png")

    def update(self, message: Message) -> Message:
        if self._sending:
            image = picture(message, *png.CODES)
            return message.replaced([Vocab("png"), image.code, png.encode(self._cv2, image)])
        match message.as_(Bottle):
            case ["png", str(code), bytes(data)] if code in png.CODES:
                return message.replaced(png.decode(self._cv2, data, str(code), self._limit))
        raise DecodeError("this is not a PNG of image_compression_png: does the sender use it?")
