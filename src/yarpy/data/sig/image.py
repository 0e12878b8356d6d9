"""Image: a picture of any pixel type, as yarp::sig::Image sends it.

    60 bytes: 256, 4, 9, 'mat', 9, pixel code, 257, 5, depth, size, quantum and orientation (int16
    each), width, height, 12, size; then the rows, each padded to a multiple of `quantum` bytes

Rules: the pixels are never copied on the way in, nor on the way out unless the rows of the array
are not laid out as the wire wants them. `array` always begins with the top row, whichever way the
sender stores it. (The same bytes are a Bottle: `[mat] [rgb] (3 48 8 4 3) {...}`.)
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, Self

from yarpy.data.array_export import ArrayExport
from yarpy.data.pickling import Wired
from yarpy.data.sig.pixel import NATURAL, Pixel, pixel, pixel_of
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import EMPTY_IMAGE

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEAD = Struct("<10ihh4i")
_MAT = 0x0074616D
_BEGINNING = (256, 4, 9, _MAT, 9)

#: row padding of images that C++ allocates, also meant by quantum 0
QUANTUM = 8


class Image(Wired, ArrayExport):
    """Width, height, a pixel code and the pixels.

    `Image(array)` takes an array of shape (height, width) or (height, width, channels); the code
    follows from its type (`mono`, `rgb`, `rgba`, `mo16`, `dec`, `rgb.` ...) unless it is given, as
    in `Image(array, "bgr")`. `array` gives the pixels back, over the same memory.
    """

    __slots__ = ("_array", "_pixels", "code", "height", "quantum", "top_down", "width")

    width: int
    height: int
    #: the pixel code; `code.code` is its integer, negative for anonymous pixels
    code: Vocab
    #: rows take a multiple of this many bytes
    quantum: int
    #: is the first row in memory the top row?
    top_down: bool

    def __init__(
        self,
        array: NDArray[Any],
        code: str | int | None = None,
        quantum: int = QUANTUM,
        *,
        top_down: bool = True,
    ) -> None:
        import numpy as np

        given = np.asarray(array)
        kind = _kind_of(given) if code is None else pixel_of(code)
        if not 0 <= quantum <= 0x7FFF:
            raise ValueError(f"a quantum of {quantum}: rows are padded to 1 to 32767 bytes")
        shape = (*given.shape, 1) if given.ndim == 2 else given.shape
        if len(shape) != 3 or shape[2] != kind.channels or given.dtype.str[1:] != kind.dtype[1:]:
            channels = f", {kind.channels}" if kind.channels > 1 else ""
            raise ValueError(
                f"an image of pixels {kind.name or kind.code!r} is an array of {kind.dtype[1:]} "
                f"and shape (height, width{channels}), not of {given.dtype} and shape {given.shape}"
            )
        self.height, self.width = shape[:2]
        self.code = kind.vocab
        self.quantum = quantum or QUANTUM
        self.top_down = top_down
        self._array: NDArray[Any] | None = None
        rows = given if top_down else given[::-1]
        self._pixels = _laid_out(rows, kind, shape, _row_bytes(self.width, kind, self.quantum))

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """An Image over the bytes of a message; DecodeError if they are not one."""
        if len(view) < _HEAD.size:
            raise Truncated(f"an Image has a header of {_HEAD.size} bytes", _HEAD.size)
        self = cls.found(view)
        if self is None:
            raise DecodeError("not an Image: the header is a different one")
        return self

    @classmethod
    def found(cls, view: bytes | bytearray | memoryview) -> Self | None:
        """As `from_wire`, but None if the bytes do not begin with the header of an image."""
        if len(view) < _HEAD.size:
            return None
        head = _HEAD.unpack_from(view)
        if head[:5] != _BEGINNING or head[6:8] != (257, 5) or head[14] != 12:
            return None
        code, depth, quantum, flipped, width, height = head[5], head[8], *head[10:14]
        # Without pixels the sides cost nothing to claim, but what works row by row takes memory.
        vast = not (width and height) and max(width, height) > EMPTY_IMAGE
        if width < 0 or height < 0 or quantum < 0 or vast:
            raise DecodeError(f"an Image of {width} times {height} with quantum {quantum}")
        self = cls.__new__(cls)
        self.width, self.height = width, height
        known = pixel(code)
        self.code = Vocab.from_code(code) if known is None else known.vocab
        self.quantum = quantum or QUANTUM
        self.top_down = flipped == 0
        self._array = None
        if not width or not height:
            self._pixels = memoryview(b"")
            return self
        kind = _received(code, depth, known)
        # C++ reads as many bytes as it computes and ignores the size in the header, and so do we.
        end = _HEAD.size + _row_bytes(width, kind, self.quantum) * height
        if len(view) < end:
            raise Truncated(f"this Image takes {end} bytes, here are {len(view)}", end)
        self._pixels = memoryview(view)[_HEAD.size : end]
        return self

    @classmethod
    def over(
        cls, pixels: memoryview, width: int, height: int, code: str | int, quantum: int = QUANTUM
    ) -> Self:
        """An Image over memory that is laid out as on the wire, rows from the top, each a multiple
        of `quantum` bytes; uncopied. ValueError if there are too few bytes."""
        kind = pixel_of(code)
        size = _row_bytes(width, kind, quantum) * height
        if width < 0 or height < 0 or len(pixels) < size:
            raise ValueError(
                f"{width} times {height} pixels take {size} bytes, here are {len(pixels)}"
            )
        self = cls.__new__(cls)
        self.width, self.height, self.code, self.quantum = width, height, kind.vocab, quantum
        self.top_down = True
        self._array = None
        self._pixels = pixels[:size]
        return self

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """Header and pixels, two blocks; the pixels are the memory of the image itself."""
        code = self.code.code
        known = pixel(code)
        rows = self.quantum, not self.top_down, self.width, self.height
        return _wire(code, known.depth if known else 0, rows, self._pixels)

    @property
    def array(self) -> NDArray[Any]:
        """The pixels, shape (height, width) or (height, width, channels), top row first.

        A view of the memory of the image: read-only if that is.
        """
        if self._array is None:
            import numpy as np

            kind = pixel(self.code.code) or Pixel(0, 0, "<u1")
            shape: tuple[int, ...] = (self.height, self.width)
            item = int(kind.dtype[-1])
            strides: tuple[int, ...] = (_row_bytes(self.width, kind, self.quantum), kind.stride)
            if kind.channels > 1:
                shape += (kind.channels,)
                strides += (item,)
            array: NDArray[Any] = np.ndarray(shape, kind.dtype, self._pixels, 0, strides)
            self._array = array if self.top_down else array[::-1]
        return self._array

    def converted(self, code: str | int, quantum: int | None = None) -> Image:
        """This image with another pixel type; ValueError if there is no way to it.

        The numbers are those C++ gets (see `conversion`): grey is (r + g + b) / 3, colour is grey
        three times, a new alpha is 255. With the same code and quantum it is the image itself.
        """
        from yarpy.data.sig.conversion import convert

        kind = pixel_of(code)
        rows = self.quantum if quantum is None else quantum or QUANTUM
        if kind.code == self.code.code and rows == self.quantum:
            return self
        array = convert(self.array, pixel_of(self.code.code), kind)
        return Image(array, kind.code, rows, top_down=self.top_down)

    def __eq__(self, other: object) -> bool:
        """The same pixels, however the rows are stored."""
        if not isinstance(other, Image):
            return NotImplemented
        mine = (self.width, self.height, self.code.code)
        if mine != (other.width, other.height, other.code.code):
            return False
        return bool((self.array == other.array).all())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        name = str(self.code) or str(self.code.code)
        return f"Image({self.width} x {self.height}, {name!r}, quantum={self.quantum})"


#: the C++ name for an image that takes the pixel type of what it receives; all do so here
FlexImage = Image


def image_blocks(
    array: NDArray[Any], kind: Pixel, quantum: int = QUANTUM
) -> tuple[bytes | memoryview, ...]:
    """Return what `Image(array, kind.code, quantum).to_wire()` returns, for an array that is known
    to fit."""
    height, width = array.shape[:2]
    shape = (height, width, kind.channels)
    pixels = _laid_out(array, kind, shape, _row_bytes(width, kind, quantum))
    return _wire(kind.code, kind.depth, (quantum, False, width, height), pixels)


def is_image(view: bytes | bytearray | memoryview) -> bool:
    """Do these bytes begin with the header of an image?"""
    if len(view) < _HEAD.size:
        return False
    head = _HEAD.unpack_from(view)
    return head[:5] == _BEGINNING and head[6:8] == (257, 5) and head[14] == 12


def _wire(
    code: int, depth: int, rows: tuple[int, bool, int, int], pixels: memoryview
) -> tuple[bytes | memoryview, ...]:
    """Header and pixels; `rows` are quantum, whether the lowest is first, width, height."""
    size = len(pixels)
    head = _HEAD.pack(256, 4, 9, _MAT, 9, code, 257, 5, depth, size, *rows, 12, size)
    return (head, pixels) if size else (head,)


def _row_bytes(width: int, kind: Pixel, quantum: int) -> int:
    return -(-width * kind.stride // quantum) * quantum


def _received(code: int, depth: int, kind: Pixel | None) -> Pixel:
    if kind is None:
        raise DecodeError(f"an Image with the unknown pixel code {str(Vocab.from_code(code))!r}")
    if kind.depth != depth:
        raise DecodeError(
            f"an Image of {kind.name or code!r} announces {depth} bytes for a pixel, "
            f"it has {kind.depth}"
        )
    return kind


def _kind_of(array: NDArray[Any]) -> Pixel:
    channels = array.shape[2] if array.ndim == 3 else 1
    name = NATURAL.get((array.dtype.str[1:], channels))
    if name is None or array.ndim not in (2, 3):
        raise ValueError(
            f"no pixel code fits an array of {array.dtype} and shape {array.shape}: those of "
            "uint8 with 3 channels are rgb, with 4 rgba; without channels uint8, uint16, int8, "
            "int32 and float32 are images, too; any other takes a code that you give: "
            'Image(array, "bgr")'
        )
    return pixel_of(name)


def _laid_out(
    rows: NDArray[Any], kind: Pixel, shape: tuple[int, ...], row_bytes: int
) -> memoryview:
    """The memory of `rows` if it is laid out as on the wire, else a copy with padded rows."""
    if not rows.size:
        return memoryview(b"")
    plain = rows.dtype.str[0] != ">" and rows.flags.c_contiguous
    if plain and row_bytes == shape[1] * kind.stride:
        return rows.data.cast("B")
    import numpy as np

    padded = np.zeros((shape[0], row_bytes), "u1")
    strides = (row_bytes, kind.stride, kind.stride // kind.channels)
    inner: NDArray[Any] = np.ndarray(shape, kind.dtype, padded.data, 0, strides)
    inner[...] = rows.reshape(shape)
    return padded.data.cast("B")
