"""Tensors of torch: see `utils/_tensors.py`, which does without this."""

from __future__ import annotations

from wrapyfi.plugins._tensor import TensorPlugin
from wrapyfi.utils.core_utils import PluginRegistrar

try:
    import torch

    HAVE_TORCH = True
except ImportError:
    HAVE_TORCH = False


@PluginRegistrar.register(types=(torch.Tensor,) if HAVE_TORCH else None)
class PytorchTensor(TensorPlugin):
    """`torch.Tensor`; `load_torch_device`, `map_torch_devices` say where it is put."""
