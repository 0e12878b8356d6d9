"""Demosaicing: colour from the grey pictures of cameras whose pixels see one colour each.

The results are those of C++ YARP, which has two implementations. For widths that are a multiple of
8 it uses algorithms of libdc1394: `nearest`, `simple`, `bilinear`, `hqlinear` and `downsample` are
bit-identical here, with the same black frame where an algorithm lacks neighbours. For other widths
it averages the existing neighbours, whatever algorithm was requested.

Rules: grey is uint8 of shape (height, width), colour uint8 of shape (height, width, 3). `green` and
`red` say where the pattern begins: the column of green in the first row, and the row of red. The
functions compute all colours of all pixels from shifted views and then choose; pixels beyond the
border count as 0.

Source for `hqlinear`: Malvar, He and Cutler, High-quality linear interpolation for demosaicing of
Bayer-patterned color images, ICASSP 2004.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Grey = NDArray[np.uint8]
    Colour = NDArray[np.uint8]
    Wide = NDArray[np.int16]

_ORDERS: Final = {"gr": (0, 0), "gb": (0, 1), "rg": (1, 0), "bg": (1, 1)}


def pattern(order: str) -> tuple[int, int]:
    """`green` and `red` of an order such as `grbg`; only its first two letters count.

    Raises ValueError.

    >>> pattern("grbg"), pattern("BGGR")
    ((0, 0), (1, 1))
    """
    try:
        return _ORDERS[order[:2].lower()]
    except KeyError:
        raise ValueError(f'a Bayer order is grbg, gbrg, rggb or bggr, not "{order}"') from None


class Views:
    """A grey picture and its shifted views: `at(1, 0)` is the picture as seen one row further down.

    Numbers are int16; the views share one array that has a margin of zeros.
    """

    def __init__(self, grey: NDArray[Any], margin: int) -> None:
        import numpy as np

        self.height, self.width = grey.shape
        self._margin = margin
        self._padded: Wide = np.pad(grey.astype(np.int16), margin)

    def at(self, down: int, right: int) -> Wide:
        """The picture shifted; its shape is that of the picture."""
        top, left = self._margin + down, self._margin + right
        return self._padded[top : top + self.height, left : left + self.width]

    def sum(self, *steps: tuple[int, int]) -> Wide:
        """The sum of some shifted views."""
        first, *others = steps
        total: Wide = self.at(*first).copy()
        for step in others:
            total += self.at(*step)
        return total


ACROSS: Final = ((0, -1), (0, 1))
ALONG: Final = ((-1, 0), (1, 0))
DIAGONAL: Final = ((-1, -1), (-1, 1), (1, -1), (1, 1))
_CROSS: Final = ACROSS + ALONG
_FAR_ACROSS: Final = ((0, -2), (0, 2))
_FAR_ALONG: Final = ((-2, 0), (2, 0))


def assembled(
    green: int, red: int, own: Any, cross: Any, across: Any, along: Any, opposite: Any
) -> Colour:
    """One picture from the values of each colour at each kind of pixel.

    own: a pixel's own colour. cross: green at pixels of another colour. across: red or blue at a
    green pixel whose row has it, along: whose column has it. opposite: red at blue, blue at red.
    """
    import numpy as np

    out: Colour = np.empty((*own.shape, 3), np.uint8)
    for row in (0, 1):
        mine, other = (0, 2) if row == red else (2, 0)  # the colour of this row besides green
        at_green = slice(row, None, 2), slice((green + row) % 2, None, 2)
        at_colour = slice(row, None, 2), slice((green + row + 1) % 2, None, 2)
        for place, channel, values in (
            (at_green, 1, own),
            (at_green, mine, across),
            (at_green, other, along),
            (at_colour, 1, cross),
            (at_colour, mine, own),
            (at_colour, other, opposite),
        ):
            out[(*place, channel)] = values[place]
    return out


def framed(picture: Colour, width: int) -> Colour:
    """The picture with a black frame."""
    picture[:width] = picture[-width:] = 0
    picture[:, :width] = picture[:, -width:] = 0
    return picture


def bilinear(grey: Grey, green: int, red: int) -> Colour:
    """The rounded mean of the nearest pixels of each colour; a frame of 1 pixel is black."""
    views = Views(grey, 1)
    across = (views.sum(*ACROSS) + 1) >> 1
    along = (views.sum(*ALONG) + 1) >> 1
    cross = (views.sum(*_CROSS) + 2) >> 2
    opposite = (views.sum(*DIAGONAL) + 2) >> 2
    return framed(assembled(green, red, grey, cross, across, along, opposite), 1)


def averaged(grey: Grey, green: int, red: int) -> Colour:
    """The mean of the nearest existing pixels of each colour, rounded down."""
    import numpy as np

    views, there = Views(grey, 1), Views(np.ones_like(grey), 1)

    def mean(*steps: tuple[int, int]) -> Wide:
        return views.sum(*steps) // np.maximum(there.sum(*steps), 1)

    means = mean(*_CROSS), mean(*ACROSS), mean(*ALONG), mean(*DIAGONAL)
    return assembled(green, red, grey, *means)


def hqlinear(grey: Grey, green: int, red: int) -> Colour:
    """Bilinear, corrected by how the pixel's own colour changes; a frame of 2 pixels is black."""
    import numpy as np

    views = Views(grey, 2)
    own = views.at(0, 0)
    diagonal = views.sum(*DIAGONAL)
    far_across, far_along = views.sum(*_FAR_ACROSS), views.sum(*_FAR_ALONG)
    far = far_across + far_along

    def limited(eighths: Wide) -> Wide:
        made: Wide = np.clip((eighths + 4) >> 3, 0, 255)
        return made

    cross = limited(4 * own + 2 * views.sum(*_CROSS) - far)
    across = limited(
        5 * own + 4 * views.sum(*ACROSS) - diagonal - far_across + ((far_along + 1) >> 1)
    )
    along = limited(
        5 * own + 4 * views.sum(*ALONG) - diagonal - far_along + ((far_across + 1) >> 1)
    )
    opposite = limited(6 * own + 2 * diagonal - ((3 * far + 1) >> 1))
    return framed(assembled(green, red, grey, cross, across, along, opposite), 2)


def _window(grey: Grey, green: int, red: int, averaged: bool) -> Colour:
    """The colours of the 2 x 2 block that starts at each pixel; last row and column black."""

    views = Views(grey, 1)
    own, right, below = views.at(0, 0), views.at(0, 1), views.at(1, 0)
    opposite = views.at(1, 1)
    at_green = (own + opposite + 1) >> 1 if averaged else opposite
    at_colour = (right + below + 1) >> 1 if averaged else right
    out = assembled(green, red, own, at_colour, right, below, opposite)
    for row in (0, 1):
        place = slice(row, None, 2), slice((green + row) % 2, None, 2), 1
        out[place] = at_green[place[:2]]
    out[-1:] = out[:, -1:] = 0
    return out


def nearest(grey: Grey, green: int, red: int) -> Colour:
    """Each colour from one of the four pixels to the right and below."""
    return _window(grey, green, red, averaged=False)


def simple(grey: Grey, green: int, red: int) -> Colour:
    """Like `nearest`, with the mean of the two green pixels."""
    return _window(grey, green, red, averaged=True)


def downsample(grey: Grey, green: int, red: int) -> Colour:
    """One pixel of each block of 2 x 2: half the width and half the height."""
    import numpy as np

    height, width = grey.shape[0] // 2, grey.shape[1] // 2
    out: Colour = np.empty((height, width, 3), np.uint8)
    blocks = grey[: 2 * height, : 2 * width].reshape(height, 2, width, 2)
    red_column = 1 - green if red == 0 else green
    out[..., 0] = blocks[:, red, :, red_column]
    out[..., 2] = blocks[:, 1 - red, :, 1 - red_column]
    greens = blocks[:, 0, :, green].astype(np.uint16) + blocks[:, 1, :, 1 - green]
    out[..., 1] = greens >> 1
    return out


def halved(grey: Grey, green: int, red: int) -> Colour:
    """`downsample` for odd widths; blocks that touch the last row or column of pixels are black."""
    out = downsample(grey, green, red)
    height, width = grey.shape
    out[(height - 1) // 2 :] = 0
    out[:, (width - 1) // 2 :] = 0
    return out


METHODS: Final[dict[str, Callable[[Grey, int, int], Colour]]] = {
    "nearest": nearest,
    "simple": simple,
    "bilinear": bilinear,
    "hqlinear": hqlinear,
    "downsample": downsample,
}
