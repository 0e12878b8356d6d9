"""Libraries that some monitors need and that are not installed with yarpy.

Rules: a monitor asks when it is created, so that a connection that cannot work is refused.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from yarpy.errors import LocalProtocolError


def needed(module: str, extra: str, by: str) -> Any:
    """The module. If it is missing, LocalProtocolError says what to install."""
    try:
        return import_module(module)
    except ImportError as error:
        raise LocalProtocolError(
            f'{by} cannot work without "{module}" ({error}): pip install "yarpy[{extra}]"'
        ) from error
