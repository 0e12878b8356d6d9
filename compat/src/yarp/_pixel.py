"""Pixels: what `image.pixel(x, y)` returns; changing it changes the image."""

from __future__ import annotations

from typing import Any


class Pixel:
    """A pixel of several channels, with a property for each. Without an image it stands alone."""

    _letters = "rgb"
    _default: Any = 0

    def __init__(self, *values: Any) -> None:
        object.__setattr__(self, "_cell", [*values] or [self._default] * len(self._letters))

    @classmethod
    def _over(cls, cell: Any) -> Any:
        self = cls.__new__(cls)
        object.__setattr__(self, "_cell", cell)
        return self

    def __getattr__(self, name: str) -> Any:
        if name in self._letters:
            return self._cell[self._letters.index(name)].__add__(0)
        raise AttributeError(f"{type(self).__name__} has {', '.join(self._letters)}, not {name}")

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._letters:
            raise AttributeError(
                f"{type(self).__name__} has {', '.join(self._letters)}, not {name}"
            )
        self._cell[self._letters.index(name)] = value

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(str(value) for value in self._cell)})"


class PixelRgb(Pixel):
    """r, g, b of 0 to 255."""


class PixelRgba(Pixel):
    """r, g, b, a of 0 to 255."""

    _letters = "rgba"


class PixelRgbFloat(Pixel):
    """r, g, b as float32."""

    _default = 0.0


class PixelBgr(Pixel):
    """b, g, r of 0 to 255."""

    _letters = "bgr"


class PixelBgra(Pixel):
    """b, g, r, a of 0 to 255."""

    _letters = "bgra"


class PixelHsv(Pixel):
    """h, s, v of 0 to 255."""

    _letters = "hsv"


class PixelHsvFloat(PixelHsv):
    """h, s, v as float32."""

    _default = 0.0


class PixelRgbSigned(Pixel):
    """r, g, b of -128 to 127."""


class PixelRgbInt(Pixel):
    """r, g, b as int32."""
