"""NativeObject: JSON with tags, both ways, and the plug-ins of users.

Rules: the tags and texts are those of `wrap.tree`. A pickle is never read, whoever sends it.
"""

from __future__ import annotations

import json
from typing import Any

from wrapyfi.utils._shipped import for_tag, for_type
from wrapyfi.utils._tensors import gathered, planted
from wrapyfi.utils.core_utils import PluginRegistrar
from yarpy.kits.wrap.tree import PLAIN, TAG, Planter, untag

_BUILT_IN = frozenset((*PLAIN, list, tuple, dict, set))


class JsonEncoder(json.JSONEncoder):
    """`json.dumps(value, cls=JsonEncoder)`. Options of the decorator go to the plug-ins."""

    def __init__(self, **kwargs: Any) -> None:
        known = ("skipkeys", "ensure_ascii", "check_circular", "allow_nan", "sort_keys", "indent")
        known += ("separators", "default")
        self._options = {name: kwargs.pop(name) for name in [*kwargs] if name not in known}
        super().__init__(**kwargs)

    def encode(self, o: Any) -> str:
        return "".join(self.iterencode(o, True))

    def iterencode(self, o: Any, _one_shot: bool = False) -> Any:
        return super().iterencode(_Planter(self._options).plant(o), _one_shot)


class _Planter(Planter):
    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(None)
        self._options = options

    def plant(self, value: Any, depth: int = 0) -> Any:
        kind = type(value)
        plugin = None
        if PluginRegistrar.encoder_registry:
            plugin = PluginRegistrar.nearest(kind)
        elif kind in PLAIN:
            return value
        if plugin is None and kind not in _BUILT_IN:
            plugin = for_type(kind)
        if plugin is not None:
            done, tree = plugin(**self._options).encode(value)
            if done:
                tag = tree[TAG]
                return {TAG: [tag[0], *(super(_Planter, self).plant(one) for one in tag[1:])]}
        if kind not in PLAIN and hasattr(value, "shape"):
            found = planted(value)
            if found is not None:
                return {TAG: found}
        return super().plant(value, depth)


class JsonDecodeHook:
    """`json.loads(text, object_hook=JsonDecodeHook().object_hook)`."""

    def __init__(self, **kwargs: Any) -> None:
        self._options = kwargs

    def object_hook(self, obj: Any) -> Any:
        """A dict with a tag as what it stands for."""
        content = obj.get(TAG) if isinstance(obj, dict) else None
        if content is None:
            return obj
        if isinstance(content, list) and content:
            plugin = PluginRegistrar.decoder_registry.get(str(content[0])) or for_tag(content[0])
            if plugin is not None:
                done, found = plugin(**self._options).decode(content[0], content)
                if done:
                    return found
            tensor = gathered(content, self._options)
            if tensor is not None:
                return tensor
        return untag(obj)
