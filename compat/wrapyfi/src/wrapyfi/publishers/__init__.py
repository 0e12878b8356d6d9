"""Publishers of all middlewares, by the names that Wrapyfi gives their modules and classes."""

from __future__ import annotations

from wrapyfi.connect.publishers import FallbackPublisher, Publisher, Publishers

__all__ = ["FallbackPublisher", "Publisher", "Publishers"]
