"""TextureMapper: paints the textures of flat surfaces into a frame, as fast as numpy can.

Rules: each surface is given as rows from `left` to `right` (`lens.Spans`) and a matrix from pixels
to texels. Large surfaces are painted one by one, a whole rectangle of pixels per operation; small
ones all together, as one list of pixels, because the number of calls dominates their cost. Work
arrays are allocated once: allocating them for each picture would cost more than the arithmetic.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from yarpy.kits.sim.render.lens import Box

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[Any]


class TextureMapper:
    """Paints surfaces with these textures (rows, columns of uint32) into frames (height, width)."""

    def __init__(self, textures: Sequence[Array], width: int, height: int) -> None:
        import numpy as np

        self.sizes = np.array([texture.shape[::-1] for texture in textures])  # columns, rows
        self._across = self.sizes[:, 0].astype("i4")
        lengths = [texture.size for texture in textures]
        self._begin = np.cumsum([0, *lengths[:-1]]).astype("i4")
        self._atlas = np.concatenate([texture.ravel() for texture in textures])
        self._flat = np.split(self._atlas, self._begin[1:])
        self._width = width
        self._x = np.arange(width, dtype="f4")
        self._lines = np.ones((height, 2), "f4")  # y and 1
        self._lines[:, 0] = np.arange(height)
        self._columns = np.empty((3, 2, width), "f4")
        self._column = np.arange(width, dtype="i2")
        size = height * width
        self._places = np.empty(3 * size, "f4")
        self._whole = np.empty(2 * size, "i4")
        self._masks = np.empty(2 * size, bool)
        self._texels = np.empty(size, "u4")

    def places(self, matrix: Array, box: Box) -> Array:
        """Return where on a surface the pixels of a box are: u, v, and one over the depth."""
        import numpy as np

        high, wide = box.bottom - box.top, box.right - box.left
        out = self._places[: 3 * high * wide].reshape(3, high, wide)
        # A sum over rows and columns as a matrix product, which is the fastest way.
        columns = self._columns[:, :, :wide]
        columns[:, 0] = matrix[:, 1, None]
        np.multiply(matrix[:, 0, None], self._x[box.left : box.right], out=columns[:, 1])
        columns[:, 1] += matrix[:, 2, None]
        np.matmul(self._lines[box.top : box.bottom], columns, out=out)
        np.divide(out[:2], out[2], out=out[:2])
        return out

    def fill(
        self,
        frame: Array,
        number: int,
        matrix: Array,
        left: Array,
        right: Array,
        box: Box,
        first: bool = False,
    ) -> None:
        """Paint surface `number` from `left` to `right` (height,), all of which is in `box`.

        first: the rest of the box will be painted over, so it may contain anything.
        """
        import numpy as np

        high, wide = box.bottom - box.top, box.right - box.left
        size = high * wide
        places = self.places(matrix, box)
        whole = self._whole[: 2 * size].reshape(2, high, wide)
        np.copyto(whole, places[:2], casting="unsafe")
        column, row = whole
        row *= self._across[number]
        row += column
        texels = self._texels[:size].reshape(high, wide)
        self._flat[number].take(row, out=texels, mode="clip")
        left, right = left[box.top : box.bottom], right[box.top : box.bottom]
        # The sides of a convex surface bulge outwards: what holds at both ends holds in between.
        full = max(left[0], left[-1]) <= box.left and min(right[0], right[-1]) >= box.right
        if full or first:
            box.of(frame)[...] = texels
            return
        x = self._column[box.left : box.right]
        inside, other = self._masks[: 2 * size].reshape(2, high, wide)
        np.greater_equal(x, left[:, None], out=inside)
        np.less(x, right[:, None], out=other)
        inside &= other
        np.copyto(box.of(frame), texels, where=inside)

    def sprinkle(
        self, frame: Array, numbers: Array, matrices: Array, left: Array, right: Array
    ) -> None:
        """Paint surfaces `numbers` (n,), each over those before it: from `left` to `right`
        (n, height), with their matrices (n, 3, 3)."""
        import numpy as np

        which, row = (left < right).nonzero()
        if not len(which):
            return
        first = left[which, row].astype(np.intp)
        length = right[which, row] - first
        past = np.cumsum(length)
        shift = first - past + length  # from the index in the list to x
        # For each row of each surface: u, v, 1/z as functions of x; where its texture begins.
        matrix = matrices[which]
        table = np.empty((6, len(which)), "f4")
        table[:3] = matrix[:, :, 0].T
        table[3:] = (matrix[:, :, 1] * row[:, None] + matrix[:, :, 2]).T
        number = numbers[which]
        places = np.array([shift, row * self._width + shift, self._across[number],
                           self._begin[number]], "i4")  # fmt: skip
        slope_and_rest = np.repeat(table, length, axis=1)
        x, pixel, across, begin = np.repeat(places, length, axis=1)
        count = np.arange(past[-1], dtype="i4")
        x += count
        pixel += count
        place = slope_and_rest[:3]
        place *= x
        place += slope_and_rest[3:]
        column, line = (place[:2] / place[2]).astype("i4")
        line *= across
        line += column
        line += begin
        frame.reshape(-1)[pixel] = self._atlas.take(line, mode="clip")
