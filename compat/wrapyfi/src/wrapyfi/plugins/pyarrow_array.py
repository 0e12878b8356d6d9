"""Arrays of structures of Apache Arrow.

    ["PyArrowArray", pickle, base64 of a stream of Arrow with one column]

Rules: what `_extra` says of pickles. What comes is validated, for Arrow trusts its offsets.
"""

from __future__ import annotations

from typing import Any

from wrapyfi.plugins._extra import ours_of, pickled
from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError

try:
    import pyarrow as pa

    HAVE_PYARROW = True
except ImportError:
    HAVE_PYARROW = False

_STREAM = b"\xff\xff\xff\xff"  # a continuation mark: a stream of Arrow begins with it


@PluginRegistrar.register(types=(pa.StructArray,) if HAVE_PYARROW else None)
class PyArrowArray(Plugin):
    """`pyarrow.StructArray`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        out = pa.BufferOutputStream()
        batch = pa.record_batch([obj], names=["array"])
        with pa.ipc.new_stream(out, batch.schema) as stream:
            stream.write_batch(batch)
        return pickled("PyArrowArray", obj, out.getvalue().to_pybytes())

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        data = ours_of("PyArrowArray", obj_full, _STREAM)
        if not HAVE_PYARROW:
            return False, None
        try:
            with pa.ipc.open_stream(data) as stream:
                batch = stream.read_next_batch()
            batch.validate(full=True)
        except (pa.ArrowException, OSError, StopIteration) as error:
            raise DecodeError(f"not an array of Arrow: {error}") from error
        return True, batch.column(0)
