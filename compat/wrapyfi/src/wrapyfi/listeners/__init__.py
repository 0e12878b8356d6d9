"""Listeners of all middlewares, by the names that Wrapyfi gives their modules and classes."""

from __future__ import annotations

from wrapyfi.connect.listeners import FallbackListener, Listener, Listeners

__all__ = ["FallbackListener", "Listener", "Listeners"]
