"""Arrays of JAX: see `utils/_tensors.py`, which does without this."""

from __future__ import annotations

from wrapyfi.plugins._tensor import TensorPlugin
from wrapyfi.utils.core_utils import PluginRegistrar

try:
    import jax

    HAVE_JAX = True
except ImportError:
    HAVE_JAX = False

types = (type(jax.numpy.zeros(0)), jax.Array) if HAVE_JAX else None  # the second is abstract


@PluginRegistrar.register(types=types)
class JAXTensor(TensorPlugin):
    """`jax.Array`."""
