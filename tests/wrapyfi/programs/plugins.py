"""Values of other libraries as texts of Wrapyfi, by either `wrapyfi`: prints one text for each, and
what it reads of those that come."""

import datetime
import importlib
import json
import sys
from typing import Any

import dask.array
import dask.dataframe
import jax
import numpy as np
import pandas
import pint
import pyarrow
import xarray
import zarr
from PIL import Image

from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder

if sys.argv[1] == "original":  # which has to be told
    for name in ("pillow_image", "pandas_data", "xarray_data", "pint_quantities", "dask_data"):
        importlib.import_module(f"wrapyfi.plugins.{name}")
    for name in ("zarr_array", "pyarrow_array", "jax_tensor"):
        importlib.import_module(f"wrapyfi.plugins.{name}")

frame = pandas.DataFrame(
    {
        "n": np.array([1, 2, 3], "i2"),
        "x": [0.5, float("nan"), 2.5],
        "word": ["a", None, "ä"],
        "kind": pandas.Categorical(["u", "v", "u"], ["v", "u"], ordered=True),
        "when": pandas.to_datetime(["2024-01-01", "2024-01-02", None]).tz_localize("Europe/Rome"),
        "whole": pandas.array([1, None, 3], dtype="Int64"),
    },
    index=pandas.Index([10, 20, 30], name="row"),
)
rows = pandas.MultiIndex.from_tuples([("a", 1), ("b", 2)], names=["k", None])
group = zarr.create_group({})
group.attrs["who"] = "me"
group.create_array("inner", data=np.arange(4.0))
pixels = np.arange(24, dtype="u1").reshape(2, 4, 3)
one = dask.dataframe.from_pandas(pandas.DataFrame({"a": [1, 2], "b": ["x", "y"]}), npartitions=1)
VALUES = {
    "picture": Image.fromarray(pixels),
    "frame": frame,
    "series": pandas.Series([1.5, 2.5], index=rows, name="s"),
    "labelled": xarray.DataArray(
        [[1.0, 2.0]],
        dims=("y", "x"),
        coords={"x": [5, 6], "t": datetime.datetime(2024, 1, 2)},
        name="heat",
    ),
    "dataset": xarray.Dataset({"v": ("i", [1, 2])}, attrs={"unit": "m"}),
    "quantity": pint.get_application_registry().Quantity(9.81, "meter / second ** 2"),
    "lazy": dask.array.arange(6, chunks=3).reshape(2, 3),
    "table": one,
    "stored": zarr.array(np.arange(6, dtype="f4").reshape(2, 3)),
    "group": group,
    "structure": pyarrow.array([{"a": 1, "b": "x"}, {"a": 2, "b": None}]),
    "jax": jax.numpy.arange(3.0),
}


def shown(value: Any) -> str:
    """What two programs must agree on."""
    if isinstance(value, Image.Image):
        return f"{value.mode} {value.size} {np.asarray(value).tolist()}"
    if isinstance(value, pandas.DataFrame):
        types = [f"{column}: {kind}" for column, kind in value.dtypes.items()]
        return f"{types} {value.index.names} {value.to_csv()!r}"
    if isinstance(value, pandas.Series):
        return f"{value.dtype} {value.name} {value.index.names} {value.to_csv()!r}"
    if isinstance(value, (xarray.DataArray, xarray.Dataset)):
        return f"{type(value).__name__} {value.to_dict()}"
    if isinstance(value, pint.Quantity):
        return f"{value.magnitude} {value.units:D}"
    if isinstance(value, dask.array.Array):
        return f"dask {value.compute().tolist()}"
    if isinstance(value, dask.dataframe.DataFrame):
        return f"dask {value.compute().to_csv()!r}"
    if isinstance(value, zarr.Array):
        return f"zarr {value.dtype} {value[...].tolist()}"
    if isinstance(value, zarr.Group):
        return f"zarr {dict(value.attrs)} {[(n, a[...].tolist()) for n, a in value.arrays()]}"
    if isinstance(value, pyarrow.StructArray):
        return f"arrow {value.type} {value.to_pylist()}"
    return f"{type(value).__name__} {value!r}"


for name, value in VALUES.items():
    try:
        text = json.dumps(value, cls=JsonEncoder)
    except Exception as error:  # as of the original with zarr 3
        print(json.dumps([name, f"{type(error).__name__}: {error}", None]), flush=True)
        continue
    print(json.dumps([name, shown(value), text]), flush=True)
print("all", flush=True)
hook = JsonDecodeHook().object_hook
for line in sys.stdin:
    name, _, text = json.loads(line)
    try:
        print(json.dumps([name, shown(json.loads(text, object_hook=hook))]), flush=True)
    except Exception as error:
        print(json.dumps([name, f"{type(error).__name__}: {error}"]), flush=True)
