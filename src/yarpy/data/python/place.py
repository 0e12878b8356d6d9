"""Place: where in a list, dict or dataclass something stands that cannot be sent: `["a"][3].x`.

Rules: it is looked for once the error is there, so that what can be sent pays nothing. Of several
the first is told, as it is in sending.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from yarpy.data.python import described
from yarpy.data.value import MAX_DEPTH

_SHOWN = 40  # characters of a key


def located(value: Any, error: TypeError) -> TypeError:
    """The error that sending `value` raised, with the place in front; the error itself if `value`
    is what cannot be sent."""
    path = ""
    for _ in range(MAX_DEPTH):
        found = next(((step, item) for step, item in _items(value) if _fails(item)), None)
        if found is None:
            break
        path, value = path + found[0], found[1]
    return TypeError(f"value{path}: {error}") if path else error


def _items(value: Any) -> Iterator[tuple[str, Any]]:
    """Yield what is directly in a value, each behind the words that lead to it."""
    if isinstance(value, dict):
        for key, item in value.items():
            text = json.dumps(key, ensure_ascii=False) if isinstance(key, str) else repr(key)
            yield f"[{text if len(text) <= _SHOWN else text[:_SHOWN] + '...'}]", item
    elif isinstance(value, (list, tuple)):
        names = getattr(value, "_fields", None)  # of a NamedTuple
        for index, item in enumerate(value):
            yield f".{names[index]}" if names else f"[{index}]", item
    elif described.is_record(value):
        for name, item in described.fields_of(value).items():
            yield f".{name}", item


def _fails(value: Any) -> bool:
    with suppress(ValueError, OverflowError):  # YarpErrors of values are ValueErrors
        try:
            described.blocks(value)
        except TypeError:
            return True
    return False
