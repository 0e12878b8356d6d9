"""Shapes of arrays: numbers of numpy and its kin, and arrays that are pictures.

Rules: as `shape.py`. An array of numbers is native: a port writes it, and brings it back, as it is.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from yarpy.data.python.array import NUMBERS, array_of, is_blob
from yarpy.data.sig.image import Image as YarpImage
from yarpy.data.sig.pixel import pixel_of
from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.native import NOT_NATIVE
from yarpy.kits.wrap.value.shape import Shape, shown
from yarpy.limit import ARRAY_DIMENSIONS
from yarpy.wire.message import Message


@dataclasses.dataclass(frozen=True)
class Image:
    """In `Annotated[np.ndarray, Image("bgr")]`: the array is a picture with these pixels.

    code: a pixel code of YARP: "rgb", "bgr", "mono", "rgba", "mono16" ...
    jpeg: the quality (1 to 100) with which it travels as a JPEG; None sends every pixel.
    """

    code: str = "rgb"
    jpeg: int | None = None

    def __post_init__(self) -> None:
        pixel_of(self.code)
        if self.jpeg is not None and not 1 <= self.jpeg <= 100:
            raise ValueError(f"a JPEG has a quality of 1 to 100, not {self.jpeg}")
        if self.jpeg is not None and self.code not in ("rgb", "bgr", "mono"):
            raise ValueError(f'a JPEG holds "rgb", "bgr" or "mono", not "{self.code}"')


class Array(Shape):
    """An array of numpy, or of a library that shares memory with it."""

    def __init__(self, module: str = "numpy") -> None:
        self.module = module
        self.name = "an array"
        if module == "numpy":
            import numpy as np

            self.exact = np.ndarray

    def dump(self, value: Any) -> Any:
        array = value if type(value).__module__ == "numpy" else array_of(value)
        if array is None or not hasattr(array, "shape"):
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return array

    def load(self, plain: Any) -> Any:
        import numpy as np

        if isinstance(plain, (str, bytes, dict)) or plain is None:
            raise self._wrong(plain)
        try:
            array = np.asarray(plain)
        except (ValueError, TypeError) as error:
            raise DecodeError(f"expected {self.name}: {error}") from error
        if array.dtype.hasobject:
            raise self._wrong(plain)
        if self.module == "numpy":
            return _own(array)
        return _moved(array, self.module)

    def native(self, plain: Any) -> Any:
        """Arrays of numbers, but of grey pictures with an axis for the one channel."""
        channels = plain.shape[2] if plain.ndim == 3 else 0
        numbers = plain.dtype.str in NUMBERS and 0 < plain.ndim <= ARRAY_DIMENSIONS
        return plain if numbers and (channels != 1 or is_blob(plain)) else NOT_NATIVE

    def read(self, message: Message) -> Any:
        import numpy as np

        value = message.value
        kind = type(value)
        if kind is YarpImage:
            array = value.array
        else:
            array = value if kind is np.ndarray else message.as_(np.ndarray)
        return _own(array)


def _own(array: Any) -> Any:
    """Return an array that its owner may change: a small one came in bytes that nobody may."""
    return array if array.flags.writeable else array.copy()


def _moved(array: Any, module: str) -> Any:
    """An array of another library, which the program has imported: its hint names it."""
    import importlib

    library = importlib.import_module(module)
    if module == "torch":
        return library.from_numpy(array if array.flags.writeable else array.copy())
    if module == "tensorflow":
        return library.convert_to_tensor(array)
    return library.asarray(array)


class Picture(Shape):
    """An array that is a picture."""

    def __init__(self, image: Image) -> None:
        self.image = image
        self.name = f"a picture ({image.code})"

    def dump(self, value: Any) -> Any:
        import numpy as np

        if isinstance(value, YarpImage):
            return value.converted(self.image.code)
        try:
            return YarpImage(np.asarray(value), self.image.code)
        except ValueError as error:
            raise TypeError(f"expected {self.name}: {error}") from error

    def load(self, plain: Any) -> Any:
        import numpy as np

        if isinstance(plain, YarpImage):
            try:
                return _own(plain.converted(self.image.code).array)
            except ValueError as error:
                raise DecodeError(f"expected {self.name}: {error}") from error
        if isinstance(plain, np.ndarray) and plain.ndim in (2, 3):
            return _own(plain)  # of a peer that says nothing of its pixels
        raise self._wrong(plain)

    def native(self, plain: Any) -> Any:
        return plain

    def read(self, message: Message) -> Any:
        return message.as_(YarpImage)
