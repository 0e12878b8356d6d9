"""The pixel codes of images: names, sizes and how numpy sees them.

Rules: a code is the vocab that travels in the image header; a negative code is an anonymous pixel
of that many bytes. `depth` is the size that the header announces, `stride` the bytes that a pixel
really takes in a row: they differ for `yuvc` only, whose depth C++ announces as 1.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

from yarpy.data.value import Vocab, vocab_code


@dataclass(frozen=True, slots=True)
class Pixel:
    """One kind of pixel. `dtype` and `channels` say how an image of it looks in numpy."""

    code: int
    depth: int
    dtype: str
    channels: int = 1
    name: str = field(init=False, repr=False)
    #: the code as a word, empty for anonymous pixels, as `name` is
    vocab: Vocab = field(init=False, repr=False)
    stride: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vocab", Vocab.from_code(self.code))
        object.__setattr__(self, "name", str(self.vocab))
        object.__setattr__(self, "stride", int(self.dtype[-1]) * self.channels)


_TABLE = (
    ("mono", 1, "<u1", 1),  # grey
    ("mo16", 2, "<u2", 1),
    ("rgb", 3, "<u1", 3),
    ("rgba", 4, "<u1", 4),
    ("bgra", 4, "<u1", 4),
    ("bgr", 3, "<u1", 3),
    ("int", 4, "<i4", 1),  # grey
    ("hsv", 3, "<u1", 3),
    ("sign", 1, "<i1", 1),  # grey
    ("rgb-", 3, "<i1", 3),
    ("rgbi", 12, "<i4", 3),
    ("dec", 4, "<f4", 1),  # grey
    ("rgb.", 12, "<f4", 3),
    ("hsv.", 12, "<f4", 3),
    ("grbg", 1, "<u1", 1),  # Bayer patterns
    ("bggr", 1, "<u1", 1),
    ("gbrg", 1, "<u1", 1),
    ("rggb", 1, "<u1", 1),
    ("gr16", 2, "<u2", 1),
    ("bg16", 2, "<u2", 1),
    ("gb16", 2, "<u2", 1),
    ("rg16", 2, "<u2", 1),
    ("yuva", 1, "<u1", 1),  # 4:2:0
    ("yuvb", 1, "<u1", 1),  # 4:4:4
    ("yuvc", 1, "<u1", 2),  # 4:2:2
    ("yuvd", 1, "<u1", 1),  # 4:1:1
)

_BY_CODE = {
    vocab_code(name.encode()): Pixel(vocab_code(name.encode()), depth, dtype, channels)
    for name, depth, dtype, channels in _TABLE
}

NAMES = tuple(row[0] for row in _TABLE)

#: numpy kind and channels -> code, for arrays that come without one
NATURAL = {
    ("u1", 1): "mono",
    ("u1", 3): "rgb",
    ("u1", 4): "rgba",
    ("u2", 1): "mo16",
    ("i1", 1): "sign",
    ("i1", 3): "rgb-",
    ("i4", 1): "int",
    ("i4", 3): "rgbi",
    ("f4", 1): "dec",
    ("f4", 3): "rgb.",
}


@lru_cache(maxsize=256)
def pixel(code: int) -> Pixel | None:
    """The pixel of a code; None for 0 and for codes that YARP 3.x does not know."""
    known = _BY_CODE.get(code)
    if known is not None or code >= 0:
        return known
    size = -code
    if size == 2:
        return Pixel(code, 2, "<u2")
    if size == 4:
        return Pixel(code, 4, "<i4")
    return Pixel(code, size, "<u1", size)


@lru_cache(maxsize=256)
def pixel_of(name: str | int) -> Pixel:
    """The pixel of a name or code; ValueError that lists the names."""
    code = name if isinstance(name, int) else Vocab(name).code
    found = pixel(code)
    if found is None:
        raise ValueError(f"no pixel code {name!r}; there are {', '.join(NAMES)}")
    return found
