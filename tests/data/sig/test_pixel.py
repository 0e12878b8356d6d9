import numpy as np
import pytest

from yarpy.data.sig.pixel import NAMES, NATURAL, pixel, pixel_of
from yarpy.data.value import Vocab


def test_codes_of_cpp():
    # (from captured images)
    codes = {
        "rgb": 6449010,
        "mono": 1869508461,
        "bgr": 7497570,
        "rgba": 1633838962,
        "bgra": 1634887522,
        "rgb.": 778200946,
        "mo16": 909209453,
        "int": 7630441,
        "hsv": 7762792,
    }
    for name, code in codes.items():
        assert pixel_of(name).code == code and pixel_of(code).name == name


@pytest.mark.parametrize("name", NAMES)
def test_sizes(name):
    found = pixel_of(name)
    assert found is pixel(Vocab(name).code) and found.name == name
    assert found.stride == np.dtype(found.dtype).itemsize * found.channels
    assert found.stride == (2 if name == "yuvc" else found.depth)


@pytest.mark.parametrize(("code", "dtype", "channels"), [(-1, "<u1", 1), (-2, "<u2", 1)])
def test_anonymous(code, dtype, channels):
    found = pixel(code)
    assert (found.dtype, found.channels, found.depth) == (dtype, channels, -code)
    assert pixel(-4).dtype == "<i4" and pixel(-7).channels == 7 and pixel(-7).depth == 7


def test_unknown():
    assert pixel(0) is None and pixel(12345) is None
    with pytest.raises(ValueError, match="mono, mo16, rgb"):
        pixel_of("nope")


def test_natural_codes_fit_their_arrays():
    for (dtype, channels), name in NATURAL.items():
        found = pixel_of(name)
        assert (found.dtype[1:], found.channels) == (dtype, channels)
