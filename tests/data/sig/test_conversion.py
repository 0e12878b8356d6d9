import numpy as np
import pytest
from support.table import for_each

from yarpy.data.sig.conversion import convert
from yarpy.data.sig.image import Image
from yarpy.data.sig.pixel import NAMES, pixel_of

GREY = ("mono", "mo16", "int", "sign", "dec")
COLOUR = ("rgb", "bgr", "rgba", "bgra", "rgb-", "rgbi", "rgb.")


def one(name, *channels):
    """An image of one pixel."""
    kind = pixel_of(name)
    shape = (1, 1) if kind.channels == 1 else (1, 1, kind.channels)
    return Image(np.array(channels).reshape(shape).astype(kind.dtype), name)


@pytest.mark.parametrize(
    ("source", "before", "target", "after"),
    [
        ("rgb", (10, 20, 31), "mono", 20),
        ("rgb", (255, 255, 255), "mono", 255),
        ("bgr", (10, 20, 31), "mono", 20),
        ("rgba", (10, 20, 31, 7), "mono", 20),
        ("rgb", (255, 255, 254), "mo16", 254),
        ("rgb", (10, 20, 30), "int", 20),
        ("rgb", (255, 255, 255), "sign", -1),
        ("rgb", (1, 1, 2), "dec", 4 / 3),
        ("rgb-", (-10, -20, -31), "int", -20),
        ("rgb.", (1.5, 1.5, 2.0), "dec", 5 / 3),
        ("rgb.", (100.9, 100.9, 101.9), "mono", 101),
        ("rgbi", (300, 300, 300), "mono", 44),
        ("mono", (9,), "rgb", (9, 9, 9)),
        ("mono", (9,), "rgba", (9, 9, 9, 255)),
        ("mono", (9,), "bgra", (9, 9, 9, 255)),
        ("mono", (9,), "rgb.", (9, 9, 9)),
        ("mono", (9,), "hsv", (0, 0, 9)),
        ("mono", (200,), "sign", 100),
        ("mono", (200,), "dec", 200),
        ("mono", (200,), "mo16", 200),
        ("sign", (-100,), "mono", 28),
        ("sign", (-100,), "int", -100),
        ("mo16", (0x1234,), "mono", 0x34),
        ("mo16", (0x1234,), "rgb", (0x34, 0x34, 0x34)),
        ("mo16", (0x50,), "sign", 0x28),
        ("int", (-5,), "dec", -5),
        ("int", (300,), "mono", 44),
        ("dec", (12.9,), "mono", 12),
        ("dec", (-1.0,), "mono", 255),
        ("dec", (12.9,), "sign", 12),
        ("dec", (12.5,), "rgb.", (12.5, 12.5, 12.5)),
        ("rgb", (1, 2, 3), "bgr", (3, 2, 1)),
        ("bgr", (1, 2, 3), "rgb", (3, 2, 1)),
        ("rgb", (1, 2, 3), "rgba", (1, 2, 3, 255)),
        ("rgb", (1, 2, 3), "bgra", (3, 2, 1, 255)),
        ("rgba", (1, 2, 3, 4), "bgra", (3, 2, 1, 4)),
        ("bgra", (1, 2, 3, 4), "rgba", (3, 2, 1, 4)),
        ("rgba", (1, 2, 3, 4), "rgb", (1, 2, 3)),
        ("bgra", (1, 2, 3, 4), "rgb", (3, 2, 1)),
        ("rgba", (1, 2, 3, 4), "bgr", (3, 2, 1)),
        ("rgb", (200, 2, 3), "rgb-", (-56, 2, 3)),
        ("rgb-", (-56, 2, 3), "rgb", (200, 2, 3)),
        ("rgb.", (1.9, 256.0, -1.0), "rgb", (1, 0, 255)),
        ("rgb", (1, 2, 3), "rgb.", (1, 2, 3)),
        ("rgbi", (257, 2, 3), "bgr", (3, 2, 1)),
        ("grbg", (9,), "mono", 9),
        ("rg16", (999,), "mo16", 999),
    ],
)
def test_values(source, before, target, after):
    image = one(source, *before).converted(target)
    assert image.code == target
    expected = np.array(after).astype(pixel_of(target).dtype)
    assert np.allclose(image.array[0, 0], expected)
    assert image.array.dtype == pixel_of(target).dtype


@for_each(GREY + COLOUR, GREY + COLOUR)
def test_all_of_grey_and_colour(source, target):
    kind = pixel_of(source)
    shape = (3, 5) if kind.channels == 1 else (3, 5, kind.channels)
    array = (np.arange(np.prod(shape)).reshape(shape) % 120).astype(kind.dtype)
    image = Image(array, source, top_down=False)
    other = image.converted(target, quantum=4)
    assert (other.code, other.quantum, other.top_down) == (target, 4, False)
    assert other.array.shape[:2] == (3, 5)
    again = Image.from_wire(b"".join(other.to_wire()))
    assert (again.array == other.array).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_same_is_itself(name):
    kind = pixel_of(name)
    image = one(name, *range(kind.channels))
    assert image.converted(name) is image
    assert convert(image.array, kind, kind) is image.array


@pytest.mark.parametrize(
    ("source", "target"),
    [("hsv", "rgb"), ("grbg", "rgb"), ("rgb", "grbg"), ("yuva", "rgb"), ("rgb", "hsv")],
)
def test_no_way(source, target):
    with pytest.raises(ValueError, match=f"no conversion from pixels '{source}' to '{target}'"):
        one(source, *range(pixel_of(source).channels)).converted(target)


def test_numbers_beyond_everything():
    for value in (np.nan, np.inf, -np.inf, 1e30):
        one("dec", value).converted("mono")
