"""Values as bytes: JSON, and behind a header in JSON the pixels, the samples or a JPEG file.

Rules: where the header ends is the middleware's own (`Join`). Whoever listens understands all of
them, and frames of yarpy. What comes is checked before memory is taken (`wrap.value.payload`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

import numpy as np

import yarpy
from wrapyfi.middlewares._form import Native, Picture, Sound
from yarpy.kits.wrap.value import payload
from yarpy.kits.wrap.value.shape import ANY

#: header and body as what is sent
Join: TypeAlias = Callable[[dict[str, Any], bytes], Any]


class TextForm(Native):
    """JSON."""

    nothing: Any = None

    def spelled(self, obj: Any) -> Any:
        return self.text(obj).encode()

    def value(self, came: bytes) -> Any:
        return unframed(came) if payload.frame.is_frame(came) else self.of_text(came)


def unframed(came: bytes) -> Any:
    """The value of bytes of any of the forms. Raises DecodeError."""
    return payload.unpack(came, ANY).value


class PictureForm:
    """A header with shape and type, or without them in front of a JPEG file."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any], join: Join) -> None:
        self._picture = Picture(options)
        self._join = join

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        array = self._picture.checked(obj)
        header: dict[str, Any] = {"timestamp": time.time()}
        if self._picture.jpg:
            return self._join(header, self._picture.file(array))
        header |= {"shape": list(array.shape), "dtype": array.dtype.name}
        return self._join(header, array.tobytes())

    def value(self, came: bytes) -> Any:
        found = unframed(came)
        if isinstance(found, yarpy.Image):
            found = found.converted("bgr" if self._picture.rgb else "mono").array
        if not isinstance(found, np.ndarray):
            raise ValueError(f"expected a picture, got {type(found).__name__}")
        return found.copy()


class SoundForm:
    """A header with shape, type and rate."""

    def __init__(self, options: dict[str, Any], join: Join) -> None:
        self._sound = Sound(options)
        self._join = join
        self.nothing: Any = (None, self._sound.rate)

    def spelled(self, obj: Any) -> Any:
        row = self._sound.row(obj)
        if row is None:
            return None
        _, _, rate, samples = row
        header = {
            "shape": list(samples.shape),
            "dtype": samples.dtype.name,
            "rate": rate,
            "timestamp": time.time(),
        }
        return self._join(header, samples.tobytes())

    def value(self, came: bytes) -> Any:
        found = unframed(came)
        if isinstance(found, yarpy.Sound):
            return self._sound.shaped(found.array.T.astype("f4") / 32767), found.frequency
        if not isinstance(found, tuple) or len(found) != 2:
            raise ValueError(f"expected a sound, got {type(found).__name__}")
        samples, rate = found
        return np.array(samples), rate


def headed(join: Join) -> dict[str, Any]:
    """The forms of a middleware of bytes, by type."""
    return {
        "NativeObject": TextForm,
        "Image": partial(PictureForm, join=join),
        "AudioChunk": partial(SoundForm, join=join),
    }
