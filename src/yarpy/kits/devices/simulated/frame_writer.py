"""SimulatedFrameWriter: a screen without hardware; fakeFrameWriter in C++.

Rules: it shows pictures of one size, that of the first where none is given, and refuses others.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image


class SimulatedFrameWriter:
    """A screen that keeps the last picture. size: width and height, None for that of the first.

    last: the picture that it shows, None before the first. count: how many it has shown.
    """

    def __init__(self, size: tuple[int, int] | None = None) -> None:
        self.size = size
        self.last: Image | None = None
        self.count = 0

    def show(self, image: Image) -> None:
        """Show a picture. Raises ValueError for an empty one, and for another size."""
        size = image.width, image.height
        if not all(size) or size != (self.size or size):
            raise ValueError(f"a picture of {size[0]} x {size[1]} on a screen of {self.size}")
        self.size, self.last = size, image
        self.count += 1
