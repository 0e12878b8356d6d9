"""Adaptive homogeneity-directed demosaicing: the method `ahd` of Bayer cameras.

The picture is rebuilt twice, with green interpolated along the rows and along the columns; each
pixel comes from the version whose neighbourhood is more uniform in CIE Lab, so that colours do not
mix across an edge. A frame of 3 pixels is averaged, like pictures of odd widths.

Rules: the results are bit-identical to libdc1394's, and so to C++ YARP's. Hence the many integer
steps, and some oddities: Lab takes 65535 for white although pixels are bytes, and next to the frame
green counts as 0 where it lacks two neighbours on a side.

Source: Hirakawa and Parks, Adaptive homogeneity-directed demosaicing algorithm, IEEE Transactions
on Image Processing 14 (2005).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from yarpy.monitors.imaging.demosaic import ACROSS, ALONG, DIAGONAL, Views, assembled, averaged

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from yarpy.monitors.imaging.demosaic import Colour, Grey

_FRAME: Final = 3
_REACH: Final = 2  # pixels on each side that the interpolation of green needs

# X, Y and Z of the red, green and blue of sRGB, and of its white (D65)
_XYZ: Final = (
    (0.412453, 0.357580, 0.180423),
    (0.212671, 0.715160, 0.072169),
    (0.019334, 0.119193, 0.950227),
)
_WHITE: Final = (0.950456, 1.0, 1.088754)

Pair = tuple[tuple[int, int], tuple[int, int]]


def ahd(grey: Grey, green: int, red: int) -> Colour:
    """Colour of the same shape; the arguments are those of `yarpy.monitors.imaging.demosaic`."""
    import numpy as np

    out = averaged(grey, green, red)
    if min(grey.shape) <= 2 * _FRAME:
        return out
    views = Views(grey, _REACH)
    across, along = (
        _coloured(grey, _greened(views, green, pair), green, red) for pair in (ACROSS, ALONG)
    )
    even, upright = _uniformity(_lab(across), _lab(along))
    chosen: NDArray[Any] = (across.astype(np.uint16) + along) >> 1
    for version, better in ((across, even > upright), (along, upright > even)):
        np.copyto(chosen, version, where=better[..., None])
    inside = slice(_FRAME, -_FRAME)
    out[inside, inside] = chosen[inside, inside]
    return out


def _greened(views: Views, green: int, pair: Pair) -> NDArray[Any]:
    """Green everywhere, interpolated between a pair of neighbours and kept between their values."""
    import numpy as np

    own = views.at(0, 0)
    one, two = (views.at(*step) for step in pair)
    far = views.sum(*((2 * down, 2 * right) for down, right in pair))
    made = np.clip((2 * (one + own + two) - far) >> 2, np.minimum(one, two), np.maximum(one, two))
    inside = slice(_REACH, -_REACH)
    greens: NDArray[Any] = np.zeros_like(made)
    greens[inside, inside] = made[inside, inside]
    for row in (0, 1):
        here = slice(row, None, 2), slice((green + row) % 2, None, 2)
        greens[here] = own[here]
    return greens


def _coloured(grey: Grey, greens: NDArray[Any], green: int, red: int) -> Colour:
    """Red and blue, from their distance to green in the neighbours."""
    import numpy as np

    from_green = Views(grey - greens, 1)
    across, along = (greens + (from_green.sum(*pair) >> 1) for pair in (ACROSS, ALONG))
    opposite = greens + ((from_green.sum(*DIAGONAL) + 1) >> 2)
    made = (np.clip(values, 0, 255) for values in (greens, across, along, opposite))
    return assembled(green, red, grey, *made)


def _lab(colour: Colour) -> tuple[Any, Any, Any]:
    """Lightness and the two colour axes, in units of 1/64."""
    import numpy as np

    single = np.float32
    # The linear part of the CIE Lab curve: as far as bytes reach, out of 65535.
    curve = single(7.787) * (np.arange(257, dtype=single) / single(65535)) + single(16 / 116)
    shares = []
    for row, white in zip(_XYZ, _WHITE, strict=True):
        total: NDArray[Any] = np.full(colour.shape[:2], single(0.5))
        for channel, part in enumerate(row):
            total += single(part / white) * colour[..., channel]
        shares.append(curve[total.astype(np.intp)])
    x, y, z = shares
    values = 64 * (116 * y - 16), 64 * 500 * (x - y), 64 * 200 * (y - z)
    lightness, red_green, blue_yellow = (value.astype(np.int32) for value in values)
    return lightness, red_green, blue_yellow


def _uniformity(across: tuple[Any, Any, Any], along: tuple[Any, Any, Any]) -> tuple[Any, Any]:
    """For both versions, how similar the 3 x 3 pixels around each one are to their neighbours."""
    import numpy as np

    light: list[list[Any]] = []  # by version and by neighbour: left, right, above, below
    tint: list[list[Any]] = []
    for lab in (across, along):
        steps = [[c - np.roll(c, shift, (0, 1)) for c in lab] for shift in (*ACROSS, *ALONG)]
        light.append([abs(step[0]) for step in steps])
        tint.append([step[1] ** 2 + step[2] ** 2 for step in steps])
    # The tolerance is how much each version differs along its own direction of interpolation.
    limits = [
        np.minimum(np.maximum(*kind[0][:2]), np.maximum(*kind[1][2:])) for kind in (light, tint)
    ]
    found = []
    for lights, tints in zip(light, tint, strict=True):
        alike: NDArray[Any] = np.zeros(across[0].shape, np.int16)
        for one, other in zip(lights, tints, strict=True):
            alike += (one <= limits[0]) & (other <= limits[1])
        rows = alike + np.roll(alike, 1, 0) + np.roll(alike, -1, 0)
        found.append(rows + np.roll(rows, 1, 1) + np.roll(rows, -1, 1))
    return found[0], found[1]
