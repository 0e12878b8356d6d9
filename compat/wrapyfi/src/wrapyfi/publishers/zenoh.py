"""Publishers over Zenoh: ZenohPublisher, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.publishers import Publisher, Publishers

globals().update(classes(Publishers, "zenoh"))

__all__ = ["Publisher", "Publishers", *classes(Publishers, "zenoh")]
