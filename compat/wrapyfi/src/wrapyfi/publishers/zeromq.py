"""Publishers over ZeroMQ: ZeroMQPublisher, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.publishers import Publisher, Publishers

globals().update(classes(Publishers, "zeromq"))

__all__ = ["Publisher", "Publishers", *classes(Publishers, "zeromq")]
