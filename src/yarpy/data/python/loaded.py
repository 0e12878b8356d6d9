"""Libraries that a program has imported: only then can it have values of theirs."""

from __future__ import annotations

import sys
from typing import Any


def loaded(name: str) -> Any:
    """Return an imported module; None if it is not imported, or not whole yet: another thread is
    about to import it."""
    module = sys.modules.get(name)
    # What Python itself goes by (`_initializing`) for the same question.
    if module is None or getattr(getattr(module, "__spec__", None), "_initializing", False):
        return None
    return module
