"""The classes of one side of a middleware by the names that Wrapyfi gives them.

    globals().update(classes(Listeners, "yarp"))     # YarpListener, YarpImageListener ...

Rules: the classes are those that are registered. A middleware whose library is missing is an
ImportError here, as it is there.
"""

from __future__ import annotations

import importlib
from typing import Any

from wrapyfi.connect._registry import SHIPPED, Registry


def classes(registry: type[Registry], middleware: str) -> dict[str, Any]:
    """Return the class of each type, and the one that they have in common."""
    importlib.import_module(SHIPPED[middleware])
    found = [each for key, each in registry.registry.items() if key.endswith(f":{middleware}")]
    common = {each.__mro__[1] for each in found}
    return {each.__name__: each for each in [*common, *found]}
