"""Frames of pandas as a text: what each column is, and its numbers as .npy.

    {"kind": "DataFrame", "columns": ROW, "index": ROW, "data": [ROW ...], "attrs": {...}}
    ROW = ["npy", array] | ["range", start, stop, step] | ["zoned", array, zone]
          | ["category", array of codes, ROW, ordered] | ["multi", [ROW ...]] | [type, [value ...]]

Rules: the types that a text may name are a list; nothing else is looked up.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.tree import from_text, to_text

MARK: Final = b'{"kind": '
_LISTED: Final = frozenset(
    (
        *("object", "str", "string", "boolean", "Float32", "Float64"),
        *(f"{sign}nt{bits}" for sign in ("I", "UI") for bits in (8, 16, 32, 64)),
    )
)
_WRONG: Final = (ValueError, TypeError, LookupError, AttributeError, OverflowError)


def to_bytes(obj: Any) -> bytes:
    """The form of a frame or a series. Raises TypeError for what it cannot hold."""
    import pandas

    frame = isinstance(obj, pandas.DataFrame)
    columns = [obj.iloc[:, i] for i in range(obj.shape[1])] if frame else [obj]
    found = {
        "kind": "DataFrame" if frame else "Series",
        "columns": _row(obj.columns) if frame else None,
        "name": None if frame else _plain(obj.name),
        "index": _row(obj.index),
        "data": [_row(column) for column in columns],
        "attrs": dict(obj.attrs),
    }
    return to_text(found).encode()


def of_bytes(data: bytes) -> Any:
    """The frame or series of a form. Raises DecodeError."""
    import pandas

    found = from_text(data)
    try:
        index = _index(found["index"])
        columns = [_values(row) for row in found["data"]]
        if found["kind"] == "DataFrame":
            table = dict(enumerate(columns))
            made = pandas.DataFrame(table) if columns else pandas.DataFrame(index=index)
            made.columns = _index(found["columns"])
        else:
            made = pandas.Series(columns[0], name=found["name"])
        made.index = index  # not before, or columns would be sorted by it
        made.attrs.update(found["attrs"])
    except _WRONG as error:
        raise DecodeError(f"not a frame of pandas: {error}") from error
    return made


def _plain(label: Any) -> Any:
    return label.item() if hasattr(label, "item") and not hasattr(label, "isoformat") else label


def _row(values: Any) -> list[Any]:
    """A column or an index, and the names of the latter at the end."""
    import numpy as np
    import pandas

    if isinstance(values, pandas.MultiIndex):
        levels = [_row(values.get_level_values(i)) for i in range(values.nlevels)]
        return ["multi", levels, [_plain(name) for name in values.names]]
    named = [_plain(values.name)] if isinstance(values, pandas.Index) else []
    if isinstance(values, pandas.RangeIndex):
        return ["range", values.start, values.stop, values.step, *named]
    kind = values.dtype
    if isinstance(kind, pandas.CategoricalDtype):
        codes = np.asarray(values.array.codes)
        return ["category", codes, _row(kind.categories), bool(kind.ordered), *named]
    if isinstance(kind, pandas.DatetimeTZDtype):
        moments = pandas.DatetimeIndex(values).tz_convert("UTC").tz_localize(None)
        return ["zoned", moments.to_numpy(), str(kind.tz), *named]
    if isinstance(kind, np.dtype) and kind.kind in "biufcmM":
        return ["npy", values.to_numpy(), *named]
    name = str(kind)
    if name not in _LISTED:
        raise TypeError(f"a column of {name} cannot be sent: make it numbers, texts or dates")
    if name == "object":
        return [name, [_plain(item) for item in values], *named]
    return [name, [None if pandas.isna(item) else _plain(item) for item in values], *named]


def _values(row: list[Any]) -> Any:
    """The values of a column."""
    import pandas

    kind, content = row[0], row[1]
    if kind == "npy":
        return pandas.Series(content.copy())
    if kind == "range":
        return pandas.RangeIndex(content, row[2], row[3])
    if kind == "category":
        made = pandas.CategoricalDtype(_values(row[2]), row[3])
        return pandas.Series(pandas.Categorical.from_codes(content, dtype=made))
    if kind == "zoned":
        return pandas.Series(pandas.DatetimeIndex(content).tz_localize("UTC").tz_convert(row[2]))
    if kind not in _LISTED:
        raise DecodeError(f"a column of {str(kind)[:80]}")
    return pandas.Series(content, dtype=kind)


def _index(row: list[Any]) -> Any:
    """The index of a row, with its names."""
    import pandas

    if row[0] == "multi":
        arrays = [_values(each) for each in row[1]]
        return pandas.MultiIndex.from_arrays(arrays, names=row[2])
    found = pandas.Index(_values(row))
    return found.rename(row[-1])
