"""The image in a message, for monitors that take images of some pixel types only."""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError
from yarpy.wire.message import Message


def picture(message: Message, *codes: str) -> Image:
    """The message as an Image of one of the pixel types `codes`. Raises DecodeError."""
    wanted = f"expected an image of pixels {' or '.join(codes)}"
    try:
        image = message.as_(Image)
    except DecodeError as error:
        raise DecodeError(f"{wanted}: {error}") from error
    if str(image.code) not in codes:
        raise DecodeError(f'{wanted}, got "{image.code}"')
    return image
