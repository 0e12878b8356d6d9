"""Frames and series of pandas.

    ["PandasData", pickle, ours]                       pandas 2 and newer
    ["PandasLegacyData", base64 of JSON, "Series"]     what Wrapyfi sends with pandas 1

Rules: what `_extra` says of pickles. The form of ours keeps types, names, order and attributes;
what a column of objects holds must be a value that Wrapyfi sends.
"""

from __future__ import annotations

import io
from base64 import b64decode, b64encode
from typing import Any

from wrapyfi.plugins import _pandas_form as form
from wrapyfi.plugins._extra import ours_of, pickled
from wrapyfi.utils.core_utils import Plugin, PluginRegistrar

try:
    import pandas

    HAVE_PANDAS = True
except ImportError:
    HAVE_PANDAS = False

_KINDS = (pandas.DataFrame, pandas.Series) if HAVE_PANDAS else None
_OLD = HAVE_PANDAS and int(pandas.__version__.partition(".")[0]) < 2


@PluginRegistrar.register(types=None if _OLD else _KINDS)
class PandasData(Plugin):
    """`pandas.DataFrame`, `pandas.Series`, with their types."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        return pickled("PandasData", obj, form.to_bytes(obj))

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        return HAVE_PANDAS, form.of_bytes(ours_of("PandasData", obj_full, form.MARK))


@PluginRegistrar.register(types=_KINDS if _OLD else None)
class PandasLegacyData(Plugin):
    """The same by way of JSON, which guesses types."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        frame = isinstance(obj, pandas.DataFrame)
        text = (obj if frame else obj.to_frame()).to_json(orient="split")
        data = b64encode(text.encode()).decode()
        kind = "DataFrame" if frame else "Series"
        return True, {"__wrapyfi__": ("PandasLegacyData", data, kind)}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_PANDAS:
            return False, None
        data = io.BytesIO(b64decode(obj_full[1], validate=True))
        found = pandas.read_json(data, orient="split")
        return True, found.iloc[:, 0] if obj_full[2] == "Series" else found
