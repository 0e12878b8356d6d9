"""NativeObject: JSON with tags, both ways, and the plug-ins of users.

Rules: the tags and texts are those of `wrap.value.tree`. A pickle is never read, whoever sends it.
"""

from __future__ import annotations

import json
from typing import Any

from wrapyfi.utils._shipped import for_tag, for_type
from wrapyfi.utils._tensors import gathered, planted
from wrapyfi.utils.core_utils import PluginRegistrar
from yarpy.kits.wrap.value.tree import OWN, PLAIN, TAG, TreeEncoder, text_of_array, untag


class JsonEncoder(json.JSONEncoder):
    """`json.dumps(value, cls=JsonEncoder)`. Options of the decorator go to the plug-ins."""

    def __init__(self, **kwargs: Any) -> None:
        known = ("skipkeys", "ensure_ascii", "check_circular", "allow_nan", "sort_keys", "indent")
        known += ("separators", "default")
        options = {name: kwargs.pop(name) for name in [*kwargs] if name not in known}
        super().__init__(**kwargs)
        self._as_usual = not kwargs
        self._usual, self._plugged = _LibraryEncoder(options), _PluginEncoder(options)

    def encode(self, o: Any) -> str:
        tree = self._tree(o)
        alone = text_of_array(tree) if self._as_usual else None
        return alone or "".join(super().iterencode(tree, True))

    def iterencode(self, o: Any, _one_shot: bool = False) -> Any:
        return super().iterencode(self._tree(o), _one_shot)

    def _tree(self, value: Any) -> Any:
        encoder = self._plugged if PluginRegistrar.encoder_registry else self._usual
        return encoder.encode(value)


class _LibraryEncoder(TreeEncoder):
    """Knows the libraries that Wrapyfi has plug-ins for."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(None)
        self._options = options

    def _encode_other(self, value: Any, below: int) -> Any:
        found = self._by(for_type(type(value)), value)
        if found is None and hasattr(value, "shape"):
            tag = planted(value)
            found = None if tag is None else {TAG: tag}
        return super()._encode_other(value, below) if found is None else found

    def _by(self, plugin: Any, value: Any) -> Any:
        """The tree that a plug-in makes of a value; None for none."""
        done, tree = (False, None) if plugin is None else plugin(**self._options).encode(value)
        if not done:
            return None
        name, *rest = tree[TAG]
        return {
            TAG: [name, *(x if type(x) in PLAIN else TreeEncoder.encode(self, x) for x in rest)]
        }


class _PluginEncoder(_LibraryEncoder):
    """Asks the plug-ins of users first, about every value."""

    plain = frozenset()

    def encode(self, value: Any, depth: int = 0) -> Any:
        found = self._by(PluginRegistrar.nearest(type(value)), value)
        if found is None and type(value) in PLAIN:
            return value
        return super().encode(value, depth) if found is None else found


class JsonDecodeHook:
    """`json.loads(text, object_hook=JsonDecodeHook().object_hook)`."""

    def __init__(self, **kwargs: Any) -> None:
        self._options = kwargs

    def object_hook(self, obj: Any) -> Any:
        """A dict with a tag as what it stands for."""
        content = obj.get(TAG) if isinstance(obj, dict) else None
        if content is None:
            return obj
        own = type(content) is list and content and type(content[0]) is str and content[0] in OWN
        if isinstance(content, list) and content and not own:
            plugin = PluginRegistrar.decoder_registry.get(str(content[0])) or for_tag(content[0])
            if plugin is not None:
                done, found = plugin(**self._options).decode(content[0], content)
                if done:
                    return found
            tensor = gathered(content, self._options)
            if tensor is not None:
                return tensor
        return untag(obj)
