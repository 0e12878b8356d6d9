"""Arrays of MXNet: see `utils/_tensors.py`, which does without this."""

from __future__ import annotations

from typing import Any

from wrapyfi.plugins._tensor import TensorPlugin
from wrapyfi.utils.core_utils import PluginRegistrar

try:
    import mxnet

    HAVE_MXNET = True
except ImportError:
    HAVE_MXNET = False


def mxnet_device_to_str(device: Any) -> Any:
    """The name of a context: `cuda:0`; of a dict, that of all keys and values. Or ValueError."""
    if device is None:
        return "cpu:0"
    if isinstance(device, dict):
        return {mxnet_device_to_str(k): mxnet_device_to_str(v) for k, v in device.items()}
    if isinstance(device, str):
        return device.replace("gpu", "cuda")
    if isinstance(device, mxnet.Context):
        return f"{device.device_type.replace('gpu', 'cuda')}:{device.device_id}"
    raise ValueError(f"{device!r} is no context of MXNet: say cpu:0 or cuda:0")


def mxnet_str_to_device(device: Any) -> Any:
    """The context of a name. Raises ValueError."""
    if device is None:
        return mxnet.cpu()
    if isinstance(device, mxnet.Context):
        return device
    if not isinstance(device, str):
        raise ValueError(f"{device!r} is no context of MXNet: say cpu:0 or cuda:0")
    kind, _, number = device.partition(":")
    return mxnet.Context(kind.replace("cuda", "gpu"), int(number or 0))


@PluginRegistrar.register(types=(mxnet.nd.NDArray,) if HAVE_MXNET else None)
class MXNetTensor(TensorPlugin):
    """`mxnet.nd.NDArray`."""
