"""Values and types: Bottle, Property, Vector, Matrix, Image, Sound, Stamp ... and their spellings.

The names below can be imported from here; each module is loaded when its name is first used, so
that numpy is not needed (nor loaded) for programs that only exchange Bottles.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yarpy.data.bottle import Bottle, Property
    from yarpy.data.sig.image import FlexImage, Image
    from yarpy.data.sig.matrix import Matrix
    from yarpy.data.sig.pointcloud import PointCloud
    from yarpy.data.sig.sound import Sound
    from yarpy.data.sig.vector import Vector
    from yarpy.data.stamp import Stamp
    from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
    from yarpy.data.walker import Walker

__all__ = [
    "Bottle",
    "FlexImage",
    "Float32",
    "Image",
    "Int8",
    "Int16",
    "Int64",
    "Matrix",
    "PointCloud",
    "Property",
    "Sound",
    "Stamp",
    "Vector",
    "Vocab",
    "Walker",
]

_MODULES = {
    **dict.fromkeys(("Float32", "Int8", "Int16", "Int64", "Vocab"), "value"),
    **{
        name: f"sig.{name.lower()}" for name in ("Image", "Matrix", "PointCloud", "Sound", "Vector")
    },
    "FlexImage": "sig.image",
    "Property": "bottle",
}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"yarpy.data.{_MODULES.get(name, name.lower())}")
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
