"""Which class sends, takes, answers or asks for a type over a middleware, by `TYPE:MIDDLEWARE`.

Rules: a middleware that cannot be imported is not there, and the reason is told by the first method
that wanted it. Nothing is executed from the current directory: WRAPYFI_MWARE_PATHS names folders.
"""

from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

#: our own, and the module that brings each
SHIPPED = {
    "yarp": "wrapyfi.middlewares.yarp",
    "zeromq": "wrapyfi.middlewares.zeromq",
    "ros": "wrapyfi.middlewares.ros",
    "ros2": "wrapyfi.middlewares.ros2",
    "mqtt": "wrapyfi.middlewares.mqtt",
    "zenoh": "wrapyfi.middlewares.zenoh",
    "websocket": "wrapyfi.middlewares.websocket",
}
#: why a middleware is not there
missing: dict[str, str] = {}
_loaded: set[str] = set()


class Registry:
    """The common part of Publishers, Listeners, Servers and Clients."""

    registry: ClassVar[dict[str, Any]]
    mwares: ClassVar[set[str]]
    folder: ClassVar[str] = ""

    @classmethod
    def register(cls, data_type: str, communicator: str) -> Callable[[type], type]:
        """A class decorator: this class is for `data_type` over `communicator`."""

        def add(kind: type) -> type:
            cls.registry[f"{data_type}:{communicator}"] = kind
            cls.mwares.add(communicator)
            return kind

        return add

    @classmethod
    def scan(cls) -> None:
        """Load all middlewares that can be loaded."""
        for name, module in SHIPPED.items():
            try:
                importlib.import_module(module)
            except ImportError as error:
                missing[name] = str(error)
            except Exception as error:
                missing[name] = f"{type(error).__name__}: {error}"
        for folder in filter(None, os.environ.get("WRAPYFI_MWARE_PATHS", "").split(":")):
            for path in sorted(Path(folder, cls.folder).glob("*.py")):
                load_file(path, f"wrapyfi.extern.{cls.folder}.{path.stem}")

    @classmethod
    def find(cls, data_type: str, middleware: str) -> Any:
        """The class, or the one that does nothing; that is told once."""
        key = f"{data_type}:{middleware}"
        found = cls.registry.get(key)
        if found is None:
            if middleware not in ("none", "None", "fallback"):
                reason = missing.get(middleware, "no package brings it")
                if middleware in SHIPPED and middleware not in missing:
                    asks = cls.folder in ("clients", "servers")
                    what = "requests" if asks and middleware not in cls.mwares else "such type"
                    reason = f"Wrapyfi has no {what} over it"
                logging.warning(
                    "[wrapyfi] no %s for %s over %s (%s): nothing is sent or received",
                    cls.folder.removesuffix("s"),
                    data_type,
                    middleware,
                    reason,
                )
            found = cls.registry["MMO:fallback"]
        return found


def load_file(path: Path, name: str) -> None:
    """Run a file that a user names as a module of ours."""
    if name in _loaded or path.stem == "__init__":
        return
    _loaded.add(name)
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        return
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
