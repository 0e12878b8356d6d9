"""Tensors of TensorFlow: see `utils/_tensors.py`, which does without this."""

from __future__ import annotations

from wrapyfi.plugins._tensor import TensorPlugin
from wrapyfi.utils.core_utils import PluginRegistrar

try:
    import tensorflow

    HAVE_TENSORFLOW = True
except ImportError:
    HAVE_TENSORFLOW = False


@PluginRegistrar.register(types=(tensorflow.Tensor,) if HAVE_TENSORFLOW else None)
class TensorflowTensor(TensorPlugin):
    """`tensorflow.Tensor`."""
