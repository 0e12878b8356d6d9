"""Arrays and frames of dask: they are computed, and travel whole.

    ["DaskData", base64 of .npy, "Array", 1]
    ["DaskData", base64 of JSON, "DataFrame" or "Series", partitions]

Rules: the JSON is Wrapyfi's, a row an object, the index first. A series comes back as one, where
Wrapyfi makes a frame of it.
"""

from __future__ import annotations

import io
from base64 import b64decode, b64encode
from typing import Any

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.npy import from_npy, to_npy
from yarpy.limit import check_json

try:
    import dask.array as da
    import dask.dataframe as dd
    import pandas as pd

    HAVE_DASK = True
except ImportError:
    HAVE_DASK = False

_MOST = 1 << 16  # partitions


@PluginRegistrar.register(types=(dd.DataFrame, dd.Series, da.Array) if HAVE_DASK else None)
class DaskData(Plugin):
    """`dask.array.Array`, `dask.dataframe.DataFrame` and `Series`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        if isinstance(obj, da.Array):
            data, kind, parts = to_npy(obj.compute()), "Array", 1
        else:
            kind = "DataFrame" if isinstance(obj, dd.DataFrame) else "Series"
            data = obj.compute().reset_index().to_json(orient="records").encode()
            parts = obj.npartitions
        return True, {"__wrapyfi__": ("DaskData", b64encode(data).decode(), kind, parts)}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_DASK:
            return False, None
        data, (kind, parts) = b64decode(obj_full[1], validate=True), obj_full[2:4]
        if kind == "Array":
            array = from_npy(data)
            return True, da.from_array(array, chunks=array.shape)
        if kind not in ("DataFrame", "Series"):
            return False, None
        if type(parts) is not int or not 0 < parts <= _MOST:
            raise DecodeError(f"a frame in {parts!s:.80} partitions")
        check_json(data)
        found = pd.read_json(io.BytesIO(data), orient="records")
        if len(found.columns):
            found = found.set_index(found.columns[0])
            if found.index.name == "index":  # which `reset_index` calls one without a name
                found.index.name = None
        column = found.iloc[:, 0] if kind == "Series" else found
        return True, dd.from_pandas(column, npartitions=parts)
