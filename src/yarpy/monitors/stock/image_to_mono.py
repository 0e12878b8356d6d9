"""image_to_mono: colour or grey images of any type as pixels `mono`. Only in yarpy, not in C++.

Grey is (r + g + b) / 3, as C++ YARP converts images; see `Image.converted`.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError
from yarpy.monitors.base import Place
from yarpy.wire.message import Message


class ImageToMono:
    """Removes the colours, at either end."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Image:
        image = message.as_(Image)
        try:
            return image.converted("mono")
        except ValueError as error:
            raise DecodeError(str(error)) from error
