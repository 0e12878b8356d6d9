"""Arrays of Trax, which are those of JAX.

    ["TraxArray", pickle, base64 of .npy]

Rules: what `_extra` says of pickles. Arrays of JAX are sent as its own (`jax_tensor`) unless the
program imports this module and has Trax.
"""

from __future__ import annotations

from typing import Any

from wrapyfi.plugins._extra import ours_of, pickled
from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.kits.wrap.value.npy import from_npy, to_npy

try:
    import jax
    import jaxlib.xla_extension
    import trax  # noqa: F401

    HAVE_TRAX = True
except ImportError:
    HAVE_TRAX = False

_NPY = b"\x93NUMPY"


@PluginRegistrar.register(types=(jaxlib.xla_extension.ArrayImpl,) if HAVE_TRAX else None)
class TraxArray(Plugin):
    """`jaxlib.xla_extension.ArrayImpl`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        import numpy as np

        return pickled("TraxArray", obj, to_npy(np.asarray(obj)))

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        array = from_npy(ours_of("TraxArray", obj_full, _NPY))
        return (True, jax.numpy.array(array)) if HAVE_TRAX else (True, array)
