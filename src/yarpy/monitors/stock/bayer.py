"""bayer: turn the grey pictures of Bayer cameras into colour at the receiver's end.

The sender writes plain `mono` images; the reader gets `rgb`, without padding, and the envelope
unchanged. Parameters, as in C++ YARP (of equal names the first counts):

    size    half: a quarter of the pixels, without interpolation
    order   the first two pixels of the first two rows: grbg (default), gbrg, rggb, bggr
    method  bilinear (default), nearest, simple, hqlinear, downsample (means half), ahd,
            vng and edgesense (both need OpenCV, extra `vision`)

Rules: a pixel code that names an order (`rggb` ...) implies it unless one is given. Widths that are
not a multiple of 8 always use a method of their own, as in C++.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError, LocalProtocolError
from yarpy.monitors.base import Place
from yarpy.monitors.extra import needed
from yarpy.monitors.imaging import demosaic
from yarpy.monitors.imaging.homogeneity import ahd
from yarpy.wire.message import Message

if TYPE_CHECKING:
    from yarpy.monitors.imaging.demosaic import Colour, Grey

_ORDERS = ("grbg", "gbrg", "rggb", "bggr")
# OpenCV's name for the method, and the width of the frame that C++ YARP leaves black
_OPENCV = {"vng": ("_VNG", 2), "edgesense": ("_EA", 0)}
_METHODS = (*demosaic.METHODS, "ahd", *_OPENCV)


class Bayer:
    """Makes colour from grey."""

    def __init__(self, place: Place) -> None:
        if place.sending:
            raise LocalProtocolError(
                '"bayer" works at the receiving end: connect with tcp+recv.bayer'
            )
        first = replace(place, tokens=place.tokens[::-1], shared=place.shared[::-1])
        method = first.text("method", "bilinear")
        self._half = first.text("size") == "half" or method == "downsample"
        self._order = first.text("order").lower()
        try:
            demosaic.pattern(self._order or "grbg")
        except ValueError as error:
            raise LocalProtocolError(str(error)) from None
        self._method = _method(method)

    def update(self, message: Message) -> Image:
        image = message.as_(Image)
        code = str(image.code)
        order = self._order or (code if code in _ORDERS else "grbg")
        try:
            grey = image.converted("mono").array
        except ValueError as error:
            raise DecodeError(f"bayer takes 8-bit grey images: {error}") from error
        whole = image.width % 8 == 0
        make: Callable[[Grey, int, int], Colour]
        if self._half:
            make = demosaic.downsample if whole else demosaic.halved
        else:
            make = self._method if whole else demosaic.averaged
        return Image(make(grey, *demosaic.pattern(order)), "rgb", quantum=1)


def _method(name: str) -> Callable[[Grey, int, int], Colour]:
    """The function behind a name. Raises LocalProtocolError."""
    if name in demosaic.METHODS:
        return demosaic.METHODS[name]
    if name == "ahd":
        return ahd
    if name in _OPENCV:
        cv2 = needed("cv2", "vision", f'method "{name}" of bayer')
        return partial(_by_opencv, cv2, *_OPENCV[name])
    raise LocalProtocolError(f'bayer has no method "{name}": use one of {", ".join(_METHODS)}')


def _by_opencv(cv2: Any, method: str, frame: int, grey: Grey, green: int, red: int) -> Colour:
    import numpy as np

    if not grey.size:
        return demosaic.averaged(grey, green, red)
    order = _ORDERS[2 * green + red].upper()
    code = getattr(cv2, f"COLOR_Bayer{order}2RGB{method}")
    made: Colour = cv2.cvtColor(np.ascontiguousarray(grey), code)
    return demosaic.framed(made, frame) if frame else made
