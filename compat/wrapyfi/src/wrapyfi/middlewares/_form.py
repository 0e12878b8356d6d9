"""Values as Wrapyfi spells them, whatever the middleware: texts, pictures, sounds.

Rules: who listens also understands frames and native values of yarpy. Pictures are in OpenCV's
order of colours, whatever they are called on the way.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

import yarpy
from wrapyfi.utils.image_encoders import JpegEncoder, decode_jpg
from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder
from yarpy.kits.wrap.value.tree import array_of_text


class Native:
    """NativeObject: JSON with tags."""

    def __init__(self, options: dict[str, Any]) -> None:
        self._encoder = dict(options.get("serializer_kwargs") or {})
        self._decoder = dict(options.get("deserializer_kwargs") or {})
        self._plugins = {
            name: value
            for name, value in options.items()
            if name.startswith(("load_", "map_")) and value is not None
        }

    @cached_property
    def text(self) -> Callable[[Any], str]:
        """Return the function that makes the JSON of a value, or raises TypeError."""
        return JsonEncoder(**self._plugins, **self._encoder).encode

    @cached_property
    def _decode(self) -> Callable[[str], Any]:
        hook = JsonDecodeHook(**self._plugins).object_hook
        decode = json.JSONDecoder(object_hook=hook, **self._decoder).decode
        if self._decoder:
            return decode

        def decoded(text: str) -> Any:
            alone = array_of_text(text)
            return decode(text) if alone is None else hook(alone)

        return decoded

    def of_text(self, text: str | bytes) -> Any:
        """The value of a text. Raises ValueError."""
        if not isinstance(text, str):
            text = text.decode(json.detect_encoding(text), "surrogatepass")
        try:
            return self._decode(text)
        except (TypeError, LookupError, AttributeError, RecursionError, OverflowError) as error:
            raise yarpy.DecodeError(f"a text with tags that do not fit: {error}") from error


class Picture:
    """Image: (height, width, 3) or (height, width), bytes or float32, perhaps as JPEG."""

    def __init__(self, options: dict[str, Any]) -> None:
        self.width = options.get("width", -1)
        self.height = options.get("height", -1)
        self.rgb = options.get("rgb", True)
        self.fp = options.get("fp", False)
        self.jpg = options.get("jpg", False)

    @property
    def dtype(self) -> Any:
        return np.dtype("f4" if self.fp else "u1")

    def checked(self, image: Any) -> Any:
        """The array, laid out without gaps. Raises ValueError for another size."""
        array = np.asarray(image)
        if array.ndim == 3 and array.shape[2] == 1 and not self.rgb:
            array = array[..., 0]
        sizes = (0 < self.width != array.shape[1]) or (0 < self.height != array.shape[0])
        if array.ndim != (3 if self.rgb else 2) or (self.rgb and array.shape[2] != 3) or sizes:
            raise ValueError(
                f"a picture of the shape {array.shape}: expected is "
                f"({self.height}, {self.width}{', 3' if self.rgb else ''})"
            )
        return np.ascontiguousarray(array, self.dtype)

    def file(self, array: Any) -> bytes:
        """The picture as a JPEG file."""
        options = self.jpg if isinstance(self.jpg, dict) else {}
        found: bytes = JpegEncoder(**options).encode_jpg_image(array)
        return found

    def of_file(self, data: bytes) -> Any:
        return decode_jpg(data, self.rgb)


class Sound:
    """AudioChunk: (samples, rate), samples from -1 to 1, of the shape (n,) or (n, channels)."""

    def __init__(self, options: dict[str, Any]) -> None:
        self.channels = options.get("channels", 1)
        self.rate = options.get("rate", 44100)
        self.chunk = options.get("chunk", -1)

    def checked(self, chunk: Any) -> tuple[Any, int] | None:
        """Samples of the shape (n, channels), and the rate; None for a chunk that is none.

        Raises ValueError for another rate, length or number of channels.
        """
        samples, rate = chunk
        if samples is None:
            return None
        array = np.asarray(samples, "f4")
        array = array[:, None] if array.ndim == 1 else array
        if self.rate > 0 and rate != self.rate:
            raise ValueError(f"a sound of {rate} samples a second: expected are {self.rate}")
        if self.chunk <= 0:
            self.chunk = len(array)
        if len(array) != self.chunk or array.ndim != 2 or array.shape[1] != self.channels:
            raise ValueError(
                f"a sound of the shape {array.shape}: expected is ({self.chunk}, {self.channels})"
            )
        return array, int(rate)

    def row(self, chunk: Any) -> tuple[int, int, int, Any] | None:
        """Chunk, channels, rate and samples, as answers and ZeroMQ have them."""
        found = None if chunk is None else self.checked(chunk)
        if found is None:
            return None
        samples, rate = found
        return len(samples), samples.shape[1], rate, self.shaped(samples)

    def shaped(self, samples: Any) -> Any:
        """As it is given to listeners: one channel has one dimension."""
        array = np.asarray(samples)
        return array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array


def patience() -> float | None:
    """Seconds that whatever waits waits, WRAPYFI_TIMEOUT; None for ever."""
    text = os.environ.get("WRAPYFI_TIMEOUT", "")
    return float(text) if text else None
