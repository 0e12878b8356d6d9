"""Pictures of PIL: the file of those that come from one, else a file of PNG, or the pixels.

    ["PILImage", file as latin-1]
    ["PILImage", base64 of the pixels, size, mode]

Rules: files are read as pictures of pixels alone (a file of PostScript would be run), and no more
pixels than YARPY_MAX_PICTURE. The original sends pixels that it cannot read itself; what PNG holds
goes as PNG, which it can.
"""

from __future__ import annotations

import io
from base64 import b64decode, b64encode
from typing import Any

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError
from yarpy.limit import limits

try:
    from PIL import Image

    HAVE_PIL = True
except ImportError:
    HAVE_PIL = False

_FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TIFF", "WEBP", "PPM", "TGA", "ICO", "JPEG2000")
_PNG = ("1", "L", "LA", "I;16", "P", "RGB", "RGBA")
_MOST_BYTES = 4  # of a pixel, in the modes that PIL has, but for those of 16 bits and more


@PluginRegistrar.register(types=(Image.Image,) if HAVE_PIL else None)
class PILImage(Plugin):
    """`PIL.Image.Image`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        kind = obj.format if obj.format in _FORMATS else None
        if kind is None and obj.mode not in _PNG:
            pixels = b64encode(obj.tobytes()).decode()
            return True, {"__wrapyfi__": ("PILImage", pixels, tuple(obj.size), obj.mode)}
        options: dict[str, Any] = {}
        if kind is None:
            kind, options = "PNG", {"compress_level": 1}
        elif kind == "JPEG":
            options = {"quality": "keep"}  # as it came, not once more with losses
        out = io.BytesIO()
        obj.save(out, format=kind, **options)
        return True, {"__wrapyfi__": ("PILImage", out.getvalue().decode("latin1"))}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_PIL:
            return False, None
        if len(obj_full) == 4:
            data, size, mode = obj_full[1:]
            size = tuple(size[1][0] if size[:1] == ["tuple"] else size)
            return True, Image.frombytes(mode, size, b64decode(data, validate=True))
        return True, _opened(obj_full[1].encode("latin1"))


def _opened(data: bytes) -> Any:
    try:
        with Image.open(io.BytesIO(data), formats=_FORMATS) as picture:
            size = picture.width * picture.height * _MOST_BYTES
            if size > limits().picture:
                raise DecodeError(
                    f"a picture of {picture.width} x {picture.height} takes more than "
                    f"{limits().picture} bytes (YARPY_MAX_PICTURE)"
                )
            picture.load()
            return picture.copy()
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise DecodeError(f"not a file with a picture that is read here: {error}") from error
