"""Labelled arrays of xarray, as JSON of what `to_dict` says.

    ["XArrayData", base64 of JSON, "DataArray" or "Dataset", name]

Rules: the JSON is Wrapyfi's, with dates as {"data": ..., "dtype": ...}. Types of numbers are those
that JSON has: float64, int64; the form of Wrapyfi names them, and nobody reads that there. An array
without a name has one on the way.
"""

from __future__ import annotations

import json
from base64 import b64decode, b64encode
from datetime import date, datetime
from typing import Any

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.limit import check_json

try:
    import xarray as xr

    HAVE_XARRAY = True
except ImportError:
    HAVE_XARRAY = False

_NAMELESS = "__xarray_dataarray_variable__"  # what xarray itself calls it in files


@PluginRegistrar.register(types=(xr.DataArray, xr.Dataset) if HAVE_XARRAY else None)
class XArrayData(Plugin):
    """`xarray.DataArray`, `xarray.Dataset`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        kind, name, table = "Dataset", None, obj
        if isinstance(obj, xr.DataArray):
            kind, name = "DataArray", obj.name if obj.name is not None else _NAMELESS
            table = obj.to_dataset(name=name)
        text = json.dumps(_spelled(table.to_dict()))
        data = b64encode(text.encode()).decode()
        return True, {"__wrapyfi__": ("XArrayData", data, kind, name)}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_XARRAY:
            return False, None
        text = b64decode(obj_full[1], validate=True)
        check_json(text)
        found = xr.Dataset.from_dict(_read(json.loads(text)))
        if obj_full[2] != "DataArray":
            return True, found
        array = found[obj_full[3]]
        return True, array.rename(None) if obj_full[3] == _NAMELESS else array


def _spelled(value: Any) -> Any:
    import numpy as np

    if isinstance(value, (list, tuple)):
        return [_spelled(item) for item in value]
    if isinstance(value, dict):
        return {key: _spelled(item) for key, item in value.items()}
    if isinstance(value, np.datetime64):
        return {"data": str(value), "dtype": str(value.dtype)}
    if isinstance(value, (datetime, date)):
        return {"data": value.isoformat(), "dtype": "datetime"}
    return value.item() if isinstance(value, np.generic) else value


def _read(value: Any) -> Any:
    if isinstance(value, list):
        return [_read(item) for item in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"data", "dtype"} and isinstance(value["data"], str):
        if value["dtype"] == "datetime":
            return datetime.fromisoformat(value["data"])
        import numpy as np

        return np.datetime64(value["data"])
    return {key: _read(item) for key, item in value.items()}
