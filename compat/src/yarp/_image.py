"""Images: memory of their own or, with `setExternal`, that of somebody else, such as a numpy array.

Rules: rows of an own image are padded to 8 bytes as in C++, those of external memory to none. What
is read into an image over external memory goes there if it has the same size; otherwise the image
takes memory of its own.
"""

from __future__ import annotations

from typing import Any, ClassVar

import yarpy
from yarp._log import say
from yarp._pixel import Pixel, PixelRgb, PixelRgba, PixelRgbFloat
from yarp._portable import Portable
from yarp._vector import VectorBase
from yarpy.data.sig.pixel import pixel as pixel_kind

OWN_QUANTUM = 8
# What was warned about: numbers of a format in images of a kind.
_warned: set[tuple[int, str]] = set()


class Image(Portable):
    """The common part. Subclasses say which pixels they have."""

    _type = "yarp/image"
    _code: ClassVar[int] = 0
    _pixel: ClassVar[type[Pixel] | None] = None

    def __init__(self) -> None:
        self._width = self._height = 0
        self._quantum = 0
        self._external = False
        self._memory: memoryview = memoryview(b"")
        self._kind = self._code
        self._low = True

    # -- its size -----------------------------------------------------------------------------

    def width(self) -> int:
        return self._width

    def height(self) -> int:
        return self._height

    def getPixelCode(self) -> int:
        return self._kind

    def getPixelSize(self) -> int:
        found = pixel_kind(self._kind)
        return found.stride if found else 0

    def getQuantum(self) -> int:
        return self._quantum or (OWN_QUANTUM if self._width else 0)

    def getRowSize(self) -> int:
        """Bytes of a row, with what pads it."""
        quantum = self.getQuantum() or OWN_QUANTUM
        return -(-self._width * self.getPixelSize() // quantum) * quantum

    def getPadding(self) -> int:
        return self.getRowSize() - self._width * self.getPixelSize()

    def getRawImageSize(self) -> int:
        return self.getRowSize() * self._height

    def isPixel(self, x: int, y: int) -> bool:
        return 0 <= x < self._width and 0 <= y < self._height

    def topIsLowIndex(self) -> bool:
        return self._low

    def setTopIsLowIndex(self, flag: bool) -> None:
        self._low = flag

    def setQuantum(self, imgQuantum: int) -> None:
        """Pad rows to so many bytes."""
        if imgQuantum != self._quantum:
            self._quantum = imgQuantum
            self._allocate()

    def setPixelCode(self, imgPixelCode: int) -> None:
        self._kind = imgPixelCode

    def resize(self, imgWidth: int | Image, imgHeight: int = 0) -> None:
        """Another size, in memory of its own; with an image, the size of that."""
        if isinstance(imgWidth, Image):
            alt = imgWidth
            imgWidth, imgHeight = alt._width, alt._height
        if imgWidth < 0 or imgHeight < 0:
            raise OverflowError(f"an image of {imgWidth} times {imgHeight}")
        if (imgWidth, imgHeight) == (self._width, self._height) and len(self._memory):
            return
        if self._external:
            self._quantum = 0
        self._width, self._height = imgWidth, imgHeight
        self._allocate()

    def _allocate(self) -> None:
        self._external = False
        self._memory = memoryview(bytearray(self.getRawImageSize()))

    def zero(self) -> None:
        """Make it black."""
        if not self._memory.readonly:
            self._memory[:] = bytes(len(self._memory))

    # -- its memory ---------------------------------------------------------------------------

    def setExternal(self, mem: Any, w: int, h: int) -> None:
        """Use the memory of `mem`: bytes, a numpy array, a memoryview; rows without padding. Of a
        Vector it is a copy. As in C++ the bytes are taken as they are; numbers of another size than
        a pixel's earn a warning.

        Raises TypeError for what is not contiguous memory, ValueError if there is too little.
        """
        view = memoryview(mem._memory() if isinstance(mem, VectorBase) else mem)
        if not view.c_contiguous:
            raise TypeError("an image needs contiguous memory: numpy.ascontiguousarray makes it so")
        if view.itemsize > 1:
            self._check_numbers(view)
        raw = view.cast("B") if view.nbytes else view
        size = w * h * self.getPixelSize()
        if len(raw) < size:
            raise ValueError(f"{w} times {h} pixels take {size} bytes, here are {len(raw)}")
        self._width, self._height, self._quantum = w, h, 1
        self._external = True
        self._memory = raw[:size]

    setExternal2 = setExternal

    def _check_numbers(self, view: memoryview) -> None:
        """Warn, once in a program, of numbers that are hardly what the pixels are made of."""
        kind = pixel_kind(self._kind)
        size = 1 if kind is None else int(kind.dtype[-1])
        if view.itemsize != size and (self._kind, view.format) not in _warned:
            _warned.add((self._kind, view.format))
            say(
                "WARNING",
                f"|yarp.sig.Image| {type(self).__name__}.setExternal takes the bytes of an array "
                f"as they are: its pixels have {size} byte(s) a channel, the array's numbers "
                f"{view.itemsize} (format {view.format!r}); convert it first, as by "
                "array.astype()",
            )

    def getRawImage(self) -> int:
        """The address of the pixels, as ctypes takes it."""
        import numpy as np

        return int(np.frombuffer(self._memory, "u1").ctypes.data) if len(self._memory) else 0

    def getPixelAddress(self, x: int, y: int) -> int:
        return self.getRawImage() + y * self.getRowSize() + x * self.getPixelSize()

    def tostring(self) -> bytes:
        """The pixels as bytes."""
        return bytes(self._memory)

    def fromstring(self, str: Any, w: int, h: int) -> None:
        """Become these pixels, rows without padding."""
        data = str.encode("latin-1") if hasattr(str, "encode") else str
        self.setExternal(bytearray(data), w, h)

    @property
    def array(self) -> Any:
        """The pixels as a numpy array, shape (height, width) or (height, width, channels)."""
        return self._image().array

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        import numpy as np

        return np.asarray(self.array, dtype)

    @property
    def __array_interface__(self) -> Any:
        return self.array.__array_interface__

    # -- its pixels ---------------------------------------------------------------------------

    def pixel(self, x: int, y: int) -> Any:
        """The pixel at column `x` of row `y`: an object with r, g, b, or a number."""
        if not self.isPixel(x, y):
            raise IndexError(f"no pixel {x}, {y} in an image of {self._width} times {self._height}")
        cell = self._cells()[y, x]
        return cell.item() if self._pixel is None else self._pixel._over(cell)

    access = pixel

    def getRow(self, r: int) -> bytes:
        """Return the bytes of a row, without what pads it."""
        if not 0 <= r < self._height:
            raise IndexError(f"no row {r} (there are {self._height})")
        begin = r * self.getRowSize()
        return bytes(self._memory[begin : begin + self._width * self.getPixelSize()])

    getRowArray = getRow

    def isEqual(self, alt: Image) -> bool:
        """Return whether size, kind and every pixel are the same."""
        mine = (self._width, self._height, self._kind)
        if mine != (alt._width, alt._height, alt._kind):
            return False
        return all(self.getRow(at) == alt.getRow(at) for at in range(self._height))

    def safePixel(self, x: int, y: int) -> Any:
        """The same; black where there is none."""
        if self.isPixel(x, y):
            return self.pixel(x, y)
        return 0 if self._pixel is None else self._pixel()

    def setPixel(self, x: int, y: int, value: Any) -> None:
        """Change a pixel: a number, or one for each channel."""
        self._cells()[y, x] = value

    def _cells(self) -> Any:
        return self._image().array

    def _image(self) -> yarpy.Image:
        return yarpy.Image.over(
            self._memory, self._width, self._height, self._kind, self.getQuantum()
        )

    # -- copies -------------------------------------------------------------------------------

    def copy(self, alt: Image, w: int | None = None, h: int | None = None) -> bool:
        """Become a copy of another image, converted to the pixels of this one; with a size, scaled.

        External memory is filled if it has that size.
        """
        if not alt._width or not alt._height:
            self.resize(0, 0)
            return True
        source = alt._image()
        if w is not None and h is not None:
            source = _scaled(source, w, h)
        self._fill(source)
        return True

    def move(self, alt: Image) -> bool:
        """The same as `copy`."""
        return self.copy(alt)

    def swap(self, alt: Image) -> bool:
        mine, theirs = self.__dict__, alt.__dict__
        self.__dict__, alt.__dict__ = theirs, mine
        return True

    def _fill(self, source: yarpy.Image) -> None:
        if not self._kind:
            self._kind = source.code.code
        found = source.converted(self._kind)
        if (found.width, found.height) != (self._width, self._height):
            if self._external:
                self._quantum = 0
            self._width, self._height = found.width, found.height
            self._allocate()
        if self._memory.readonly:
            self._allocate()
        if self._width and self._height:
            self._cells()[...] = found.array

    # -- ports --------------------------------------------------------------------------------

    def _outgoing(self) -> Any:
        if not self._width or not self._height:
            import numpy as np

            kind = pixel_kind(self._kind)
            channels = kind.channels if kind else 1
            shape = (0, 0, channels) if channels > 1 else (0, 0)
            return yarpy.Image(np.zeros(shape, kind.dtype if kind else "u1"), self._kind or "mono")
        return self._image()

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(yarpy.Image)
        same = found.code.code == (self._kind or found.code.code)
        if same and found.top_down and not self._external:
            self._adopt(found)
        else:
            self._fill(found)

    def _adopt(self, found: yarpy.Image) -> None:
        """Take the memory of what has come, uncopied."""
        self._kind, self._quantum = found.code.code, found.quantum
        self._width, self._height = found.width, found.height
        self._external = False
        blocks = found.to_wire()
        self._memory = memoryview(blocks[1]) if len(blocks) > 1 else memoryview(b"")


def _scaled(source: yarpy.Image, width: int, height: int) -> yarpy.Image:
    """The nearest pixel of each."""
    import numpy as np

    rows = np.arange(height) * source.height // max(height, 1)
    columns = np.arange(width) * source.width // max(width, 1)
    return yarpy.Image(np.ascontiguousarray(source.array[rows][:, columns]), source.code.code)


def _code(name: str) -> int:
    return yarpy.Vocab(name).code


class ImageRgb(Image):
    _code = _code("rgb")
    _pixel = PixelRgb


class ImageRgba(Image):
    _code = _code("rgba")
    _pixel = PixelRgba


class ImageRgbFloat(Image):
    _code = _code("rgb.")
    _pixel = PixelRgbFloat


class ImageMono(Image):
    _code = _code("mono")


class ImageMono16(Image):
    _code = _code("mo16")


class ImageInt(Image):
    _code = _code("int")

    getPixel = Image.pixel


class ImageFloat(Image):
    _code = _code("dec")

    getPixel = Image.pixel


class FlexImage(Image):
    """Takes the pixels of what is read into it."""

    def setPixelSize(self, imgPixelSize: int) -> None:
        """Let pixels have so many bytes; if the kind has another size, they have no kind."""
        if imgPixelSize != self.getPixelSize():
            self.setPixelCode(-imgPixelSize)


def PAD_BYTES(len: int, pad: int) -> int:
    """How many bytes fill a row of `len` bytes up to a multiple of `pad`."""
    return -len % pad
