"""Arrays of CuPy: see `utils/_tensors.py`, which does without this."""

from __future__ import annotations

from typing import Any

from wrapyfi.plugins._tensor import TensorPlugin
from wrapyfi.utils.core_utils import PluginRegistrar

try:
    import cupy

    HAVE_CUPY = True
except ImportError:
    HAVE_CUPY = False


def cupy_device_to_str(device: Any) -> str:
    """The name of a device: `cuda:0` for the first. Raises ValueError."""
    if isinstance(device, str):
        return device
    if isinstance(device, (int, cupy.cuda.Device)):
        return f"cuda:{int(device)}"
    raise ValueError(f"{device!r} is no device of CuPy: say cuda:0, or 0")


def cupy_str_to_device(device_str: str) -> Any:
    """The device of a name. Raises ValueError."""
    kind, _, number = str(device_str).partition(":")
    if kind != "cuda" or not number.isdigit():
        raise ValueError(f"{device_str!r} is no device of CuPy, which has cuda:0 and so on")
    return cupy.cuda.Device(int(number))


@PluginRegistrar.register(types=(cupy.ndarray,) if HAVE_CUPY else None)
class CuPyArray(TensorPlugin):
    """`cupy.ndarray`."""
