"""Common to all plug-ins for tensors, which ask `utils/_tensors.py`."""

from __future__ import annotations

from typing import Any

from wrapyfi.utils._tensors import gathered, planted
from wrapyfi.utils.core_utils import Plugin


class TensorPlugin(Plugin):
    """Options are `load_LIBRARY_device` and `map_LIBRARY_devices`."""

    def __init__(self, **kwargs: Any) -> None:
        self._options = kwargs

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        found = planted(obj)
        return found is not None, {"__wrapyfi__": tuple(found or ())}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        found = gathered(list(obj_full), self._options)
        return found is not None, found
