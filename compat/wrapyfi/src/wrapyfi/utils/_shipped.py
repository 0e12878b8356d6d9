"""Which plug-in of this package is for a value, and which for a tag.

Rules: asking imports the plug-in, and with it its library: for a value it is there already, for a
tag it is looked for. Libraries of tensors are taken only where the program has imported them, for
they load for seconds, and an array of numpy says the same.
"""

from __future__ import annotations

import importlib
import sys
from functools import lru_cache
from importlib.util import find_spec
from typing import Any, Final

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar

#: the package that a class is of, and the plug-in for it
_PACKAGES: Final = {
    "PIL": "pillow_image",
    "pandas": "pandas_data",
    "xarray": "xarray_data",
    "pint": "pint_quantities",
    "dask": "dask_data",
    "zarr": "zarr_array",
    "pyarrow": "pyarrow_array",
    "paddle": "paddle_tensor",
}
#: the tag of a text, the package that it needs, and its plug-in
_TAGS: Final = {
    "PILImage": ("PIL", "pillow_image"),
    "PandasData": ("pandas", "pandas_data"),
    "PandasLegacyData": ("pandas", "pandas_data"),
    "XArrayData": ("xarray", "xarray_data"),
    "PintData": ("pint", "pint_quantities"),
    "DaskData": ("dask", "dask_data"),
    "ZarrData": ("zarr", "zarr_array"),
    "PyArrowArray": ("pyarrow", "pyarrow_array"),
}
#: ... and those that are read where the program has imported the package
_LOADED: Final = {
    "PaddleTensor": ("paddle", "paddle_tensor"),
    "TraxArray": ("jax", "trax_array"),
}


@lru_cache(maxsize=512)
def for_type(kind: type) -> type[Plugin] | None:
    """The plug-in for values of a class, or None."""
    for each in kind.__mro__[:-1]:
        module = _PACKAGES.get(each.__module__.partition(".")[0])
        if module is not None:
            importlib.import_module(f"wrapyfi.plugins.{module}")
            return PluginRegistrar.nearest(kind)
    return None


def for_tag(tag: Any) -> type[Plugin] | None:
    """The plug-in that reads what has a tag; None if there is none, or its library is missing."""
    package, module = _TAGS.get(tag, ("", "")) if isinstance(tag, str) else ("", "")
    if package and find_spec(package) is None:
        return None
    if not package and isinstance(tag, str) and tag in _LOADED:
        package, module = _LOADED[tag]
        if package not in sys.modules:
            return None
    if not package:
        return None
    importlib.import_module(f"wrapyfi.plugins.{module}")
    return PluginRegistrar.decoder_registry.get(tag)
