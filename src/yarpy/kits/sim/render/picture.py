"""Picture: an image that a program paints once, used as the texture of a surface.

    wall = Picture(2.0, 1.0, (0.8, 0.8, 0.7))        # 2 m wide, 1 m high, a colour
    wall.rectangle(0.5, 0.2, 1.0, 0.8, (0.2, 0.3, 0.6))
    texels = wall.texels()                           # (64, 128) uint32

Colours are red, green, blue from 0 to 1; positions are metres from the surface's corner. Slow to
make, fast to use: `texels` has one integer for each texel, bytes r, g, b, 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Colour: TypeAlias = tuple[float, float, float]

DENSITY: Final = 64  # texels per metre


class Picture:
    """A picture of `width` times `height` metres."""

    def __init__(self, width: float, height: float, colour: Colour, density: int = DENSITY) -> None:
        import numpy as np

        self.width, self.height, self.density = width, height, density
        shape = (max(1, round(height * density)), max(1, round(width * density)), 3)
        self.array: NDArray[Any] = np.empty(shape)
        self.array[:] = colour

    def rectangle(self, left: float, low: float, right: float, high: float, colour: Colour) -> None:
        """Paint a rectangle."""
        self.array[self._between(low, high), self._between(left, right)] = colour

    def checker(self, size: float, colour: Colour) -> None:
        """Paint every other square of a chessboard."""
        row, column = self._grid()
        self.array[((row // size) + (column // size)) % 2 == 1] = colour

    def frame(self, width: float, colour: Colour) -> None:
        """Paint a border."""
        edge = max(1, round(width * self.density))
        for part in (self.array[:edge], self.array[-edge:]):
            part[:] = colour
        for part in (self.array[:, :edge], self.array[:, -edge:]):
            part[:] = colour

    def window(self, left: float, low: float, right: float, high: float) -> None:
        """Paint a window with a white frame, with hills and sky outside."""
        import numpy as np

        self.rectangle(left - 0.06, low - 0.06, right + 0.06, high + 0.06, (0.95, 0.95, 0.94))
        pane = self.array[self._between(low, high), self._between(left, right)]
        rows, columns = np.indices(pane.shape[:2])
        rise, run = rows / len(pane), columns / len(pane)
        pane[:] = np.array((0.80, 0.90, 0.99)) - np.multiply.outer(rise, (0.40, 0.24, 0.06))
        far = 0.38 + 0.07 * np.sin(3.1 * run + 1.0) + 0.02 * np.sin(11 * run)
        near = 0.22 + 0.06 * np.sin(2.2 * run + 4.0)
        pane[rise < far] = (0.52, 0.66, 0.66)
        pane[rise < near] = (0.45, 0.62, 0.36)
        middle = (left + right) / 2
        self.rectangle(middle - 0.02, low, middle + 0.02, high, (0.95, 0.95, 0.94))

    def gradient(self, low: float, high: float) -> None:
        """Change the brightness from `low` at the first row to `high` at the last."""
        import numpy as np

        self.array *= np.linspace(low, high, len(self.array))[:, None, None]

    def shade(
        self, left: float, low: float, right: float, high: float, depth: float, soft: float
    ) -> None:
        """Darken a rectangle by `depth` (0 to 1), fading out over `soft` metres around it."""
        import numpy as np

        row, column = self._grid()
        across = np.maximum(np.maximum(left - column, column - right), 0)
        along = np.maximum(np.maximum(low - row, row - high), 0)
        near = np.clip(1 - np.hypot(across, along) / soft, 0, 1)
        self.array *= (1 - depth * near**2 * (3 - 2 * near))[..., None]

    def grain(self, amount: float, stretch: int = 1, seed: int = 1) -> None:
        """Roughen it like wood or plaster; `stretch` is the length of the grains in texels."""
        import numpy as np

        rows, columns = self.array.shape[:2]
        noise = np.random.default_rng(seed).normal(size=(rows, -(-columns // stretch)))
        smooth = np.repeat(noise, stretch, axis=1)[:, :columns]
        self.array *= 1 + amount * smooth[..., None]

    def texels(self) -> NDArray[np.uint32]:
        """The picture as integers, in the same orientation."""
        import numpy as np

        bytes_ = (np.clip(self.array, 0, 1) * 255).round().astype("<u4")
        packed: NDArray[Any] = bytes_[..., 0] | bytes_[..., 1] << 8 | bytes_[..., 2] << 16
        return packed

    def _between(self, start: float, stop: float) -> slice:
        return slice(max(0, round(start * self.density)), max(0, round(stop * self.density)))

    def _grid(self) -> tuple[Any, Any]:
        """The centres of the texels in metres: rows, columns."""
        import numpy as np

        rows, columns = self.array.shape[:2]
        return np.ogrid[0.5:rows:1, 0.5:columns:1][0] / self.density, (
            np.ogrid[0.5:rows:1, 0.5:columns:1][1] / self.density
        )
