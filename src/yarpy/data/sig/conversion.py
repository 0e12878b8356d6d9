"""One pixel type into another, with the numbers C++ YARP gets.

Rules: nothing is scaled. Grey is (r + g + b) / 3 without a remainder, colour from grey is the same
value three times, a missing alpha is 255, and numbers too large for the target keep their low bits.
`sign` is the half of unsigned grey, unsigned grey is `sign` plus 128. Bayer patterns may be taken
as the grey images they are; rebuilding their colours is not done here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yarpy.data.sig.pixel import Pixel

if TYPE_CHECKING:
    from numpy.typing import NDArray

_GREY = frozenset(("mono", "mo16", "int", "sign", "dec"))
_COLOUR = {
    "rgb": "rgb",
    "bgr": "bgr",
    "rgba": "rgba",
    "bgra": "bgra",
    "rgb-": "rgb",
    "rgbi": "rgb",
    "rgb.": "rgb",
}
_HSV = frozenset(("hsv", "hsv."))
_BAYER = {
    **dict.fromkeys(("grbg", "bggr", "gbrg", "rggb"), "mono"),
    **dict.fromkeys(("gr16", "bg16", "gb16", "rg16"), "mo16"),
}


def convert(array: NDArray[Any], source: Pixel, target: Pixel) -> NDArray[Any]:
    """The pixels of `array` as `target`; ValueError if there is no way from one to the other.

    Shapes are those of `Image.array`. The result may be `array` itself.
    """
    if source.code == target.code or _BAYER.get(source.name) == target.name:
        return array
    if source.name in _GREY:
        grey = array
        if target.name in _GREY:
            return _as_grey(grey, source, target)
        if target.name in _COLOUR or target.name in _HSV:
            return _spread(grey, target)
    elif source.name in _COLOUR:
        if target.name in _GREY:
            return _narrowed(_mean(array, source, target), target)
        if target.name in _COLOUR:
            return _reordered(array, source, target)
    names = (repr(kind.name or kind.code) for kind in (source, target))
    raise ValueError(f"no conversion from pixels {' to '.join(names)}")


def _narrowed(values: NDArray[Any], target: Pixel) -> NDArray[Any]:
    """The values in the type of the target: fractions are cut off, integers keep their low bits."""
    import numpy as np

    if values.dtype.kind == "f" and target.dtype[1] != "f":
        with np.errstate(invalid="ignore"):
            values = values.astype("i8")
    return values.astype(target.dtype, copy=False)


def _as_grey(grey: NDArray[Any], source: Pixel, target: Pixel) -> NDArray[Any]:
    if target.name == "sign" and source.name != "dec":
        grey = grey >> 1
    elif source.name == "sign" and target.name == "mono":
        grey = grey.astype("i2") + 128
    return _narrowed(grey, target)


def _spread(grey: NDArray[Any], target: Pixel) -> NDArray[Any]:
    import numpy as np

    out = np.empty((*grey.shape, target.channels), target.dtype)
    value = _narrowed(grey, target)
    if target.name in _HSV:
        out[..., :2] = 0
        out[..., 2] = value
        return out
    out[...] = value[..., None]
    if target.channels == 4:
        out[..., 3] = 255
    return out


def _mean(array: NDArray[Any], source: Pixel, target: Pixel) -> NDArray[Any]:
    import numpy as np

    wide = "f4" if source.dtype[1] == "f" else "u2" if source.dtype[1:] == "u1" else "i8"
    total: NDArray[Any] = array[..., 0].astype(wide)
    total += array[..., 1]
    total += array[..., 2]
    if wide == "f4" or target.dtype[1] == "f":
        return total / np.float32(3)
    if wide == "u2":
        return total // 3
    total -= np.sign(total) * (np.abs(total) % 3)
    return total // 3


def _reordered(array: NDArray[Any], source: Pixel, target: Pixel) -> NDArray[Any]:
    import numpy as np

    before, after = _COLOUR[source.name], _COLOUR[target.name]
    if len(after) == 3 and source.dtype == target.dtype:
        return array[..., 2::-1] if before[0] != after[0] else array[..., :3]
    out = np.empty((*array.shape[:2], target.channels), target.dtype)
    for index, channel in enumerate(after):
        at = before.find(channel)
        out[..., index] = 255 if at < 0 else _narrowed(array[..., at], target)
    return out
