"""Tensors of Paddle.

    ["PaddleTensor", base64 of the file of `paddle.save`, place, base64 of .npy]

Rules: the file is a pickle, and the original reads it; here the last one is read.
"""

from __future__ import annotations

import io
from base64 import b64decode, b64encode
from typing import Any

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.npy import from_npy, to_npy

try:
    import paddle

    HAVE_PADDLE = True
except ImportError:
    HAVE_PADDLE = False


def paddle_device_to_str(device: Any) -> Any:
    """The name of a place: `gpu:0`; of a dict, with all of its keys and values."""
    if device is None:
        return paddle.get_device()
    if isinstance(device, dict):
        return {paddle_device_to_str(k): paddle_device_to_str(v) for k, v in device.items()}
    # A place is spelled Place(gpu:0).
    name = str(device)
    return name.removeprefix("Place(").removesuffix(")").replace("cuda", "gpu")


def paddle_str_to_device(device: Any) -> Any:
    """The place of a name."""
    if device is None:
        return paddle.get_device()
    if not isinstance(device, str):
        return device
    kind, _, number = device.replace("cuda", "gpu").partition(":")
    return paddle.CPUPlace() if kind == "cpu" else paddle.CUDAPlace(int(number or 0))


@PluginRegistrar.register(types=(paddle.Tensor,) if HAVE_PADDLE else None)
class PaddleTensor(Plugin):
    """`paddle.Tensor`; `load_paddle_device`, `map_paddle_devices` say where it is put."""

    def __init__(
        self, load_paddle_device: Any = None, map_paddle_devices: Any = None, **kwargs: Any
    ) -> None:
        known = dict(map_paddle_devices or {})
        if load_paddle_device is not None:
            known["default"] = load_paddle_device
        self.map_paddle_devices = paddle_device_to_str(known)

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        out = io.BytesIO()
        paddle.save(obj, out)
        place = paddle_device_to_str(obj.place)
        array = b64encode(to_npy(obj.numpy())).decode()
        return True, {
            "__wrapyfi__": ("PaddleTensor", b64encode(out.getvalue()).decode(), place, array)
        }

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_PADDLE:
            return False, None
        if len(obj_full) < 4:
            raise DecodeError(
                "a PaddleTensor that comes as a pickle alone, which runs code of its sender when "
                "it is read: send a numpy array, or from a program with yarpy-wrapyfi"
            )
        array = from_npy(b64decode(obj_full[3], validate=True))
        known = self.map_paddle_devices
        place = known.get(obj_full[2], known.get("default"))
        if place is None:
            return True, paddle.to_tensor(array)
        return True, paddle.to_tensor(array, place=paddle_str_to_device(place))
