"""Plug-ins that encode types of the user's, and singletons.

    @PluginRegistrar.register(types=MyType.__mro__[:-1])
    class MyPlugin(Plugin):
        def encode(self, obj): return True, {"__wrapyfi__": ("MyPlugin", text)}
        def decode(self, obj_type, obj_full): return True, MyType(obj_full[1])

Rules: plug-ins are those that are registered, in whatever module, and those in the folders of
WRAPYFI_PLUGIN_PATHS; nothing is executed from the current directory. Star imports bring `os`,
`sys`, `Path`, `glob` and `threading` along, since plug-ins rely on it.
"""

from __future__ import annotations

import copy
import glob
import importlib
import inspect
import os
import sys
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

__all__ = [
    "WRAPYFI_MWARE_PATHS",
    "WRAPYFI_PLUGIN_PATHS",
    "Path",
    "Plugin",
    "PluginRegistrar",
    "SingletonOptimized",
    "deepcopy",
    "dynamic_module_import",
    "get_default_args",
    "glob",
    "match_args",
    "os",
    "scan_external",
    "sys",
    "threading",
]

#: variables of the environment
WRAPYFI_PLUGIN_PATHS = "WRAPYFI_PLUGIN_PATHS"
WRAPYFI_MWARE_PATHS = "WRAPYFI_MWARE_PATHS"


def deepcopy(
    obj: Any,
    exclude_keys: Iterable[str] | None = None,
    shallow_keys: Iterable[str] | None = None,
) -> Any:
    """Copy an object; without some keys of the dicts in it, and with the values of others as they
    are, in the outermost dict."""
    if exclude_keys is None:
        return copy.deepcopy(obj)
    left_out, kept = {*exclude_keys}, {*(shallow_keys or ())}
    if isinstance(obj, dict):
        return {
            key: value if key in kept else deepcopy(value, left_out)
            for key, value in obj.items()
            if key in kept or key not in left_out
        }
    if type(obj) in (list, tuple, set):
        return type(obj)(deepcopy(item, left_out) for item in obj)
    return copy.deepcopy(obj)


def get_default_args(fnc: Callable[..., Any]) -> dict[str, Any]:
    """Return the arguments of a function that have a value of their own."""
    found = inspect.signature(fnc).parameters.values()
    return {each.name: each.default for each in found if each.default is not each.empty}


def match_args(
    args: Iterable[Any],
    kwargs: Mapping[str, Any],
    src_args: Sequence[Any],
    src_kwargs: Mapping[str, Any],
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Put arguments of a call in the places of `$0` and `$name`."""

    def filled(value: Any) -> Any:
        if not isinstance(value, str) or not value.startswith("$"):
            return value
        name = value[1:]
        return src_args[int(name)] if name.isdigit() else src_kwargs[name]

    return tuple(map(filled, args)), {key: filled(value) for key, value in kwargs.items()}


class SingletonOptimized(type):
    """A metaclass: the first object of a class is the only one."""

    _instances: ClassVar[dict[type, Any]] = {}
    _lock = threading.Lock()

    def __call__(cls, *args: Any, **kwargs: Any) -> Any:
        if cls not in cls._instances:
            with cls._lock:
                if cls not in cls._instances:
                    cls._instances[cls] = super().__call__(*args, **kwargs)
        return cls._instances[cls]


class Plugin:
    """Encodes and decodes a type that JSON does not know."""

    def __init__(self, **kwargs: Any) -> None:
        pass

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        raise NotImplementedError

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        raise NotImplementedError


class PluginRegistrar:
    """All plug-ins: by type for encoding, by class name for decoding."""

    encoder_registry: ClassVar[dict[Any, type[Plugin]]] = {}
    decoder_registry: ClassVar[dict[str, type[Plugin]]] = {}

    @staticmethod
    def register(
        cls: type[Plugin] | None = None, types: Iterable[Any] | None = None
    ) -> Callable[[type[Plugin]], type[Plugin]] | type[Plugin]:
        """A class decorator."""

        def add(plugin: type[Plugin]) -> type[Plugin]:
            for kind in types or ():
                PluginRegistrar.encoder_registry[kind] = plugin
            PluginRegistrar.decoder_registry[plugin.__name__] = plugin
            return plugin

        return add if cls is None else add(cls)

    @staticmethod
    def scan() -> None:
        """Load the plug-ins of WRAPYFI_PLUGIN_PATHS."""
        scan_external(WRAPYFI_PLUGIN_PATHS, "plugins")

    @classmethod
    def encoder(cls, value: Any) -> type[Plugin] | None:
        """The plug-in for a value: of its class, or the nearest one above it."""
        return cls.nearest(type(value))

    @classmethod
    def nearest(cls, kind: type) -> type[Plugin] | None:
        """The plug-in for values of a class: its own, or the nearest one above it."""
        for each in kind.__mro__[:-1]:
            found = cls.encoder_registry.get(each)
            if found is not None:
                return found
        return None


def dynamic_module_import(modules: Iterable[str], globals_: dict[str, Any]) -> None:
    """Import modules, by file name or dotted name; those that cannot be imported are left out."""
    for module in modules:
        name = module.removesuffix(".py").replace(os.sep, ".").strip(".")
        try:
            globals_[name.rpartition(".")[2]] = importlib.import_module(name)
        except ImportError:
            continue


def scan_external(module_paths: str, component: str) -> None:
    """Load `component/*.py` of every folder in the environment variable `module_paths`."""
    from wrapyfi.connect._registry import load_file

    for number, folder in enumerate(filter(None, os.environ.get(module_paths, "").split(":"))):
        for path in sorted(Path(folder, component).glob("*.py")):
            load_file(path, f"wrapyfi.extern{number}.{component}.{path.stem}")
