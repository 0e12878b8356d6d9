"""Names that plug-ins take from here; up to 0.4 they were in this module itself."""

from __future__ import annotations

from wrapyfi.utils.core_utils import *  # noqa: F403
from wrapyfi.utils.core_utils import (
    Plugin,
    PluginRegistrar,
    SingletonOptimized,
    dynamic_module_import,
    scan_external,
)

__all__ = [
    "Plugin",
    "PluginRegistrar",
    "SingletonOptimized",
    "dynamic_module_import",
    "scan_external",
]
