"""Listeners over Zenoh: ZenohListener, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.listeners import Listener, Listeners

globals().update(classes(Listeners, "zenoh"))

__all__ = ["Listener", "Listeners", *classes(Listeners, "zenoh")]
