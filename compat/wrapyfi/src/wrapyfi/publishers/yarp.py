"""Publishers over YARP: YarpPublisher, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.publishers import Publisher, Publishers

globals().update(classes(Publishers, "yarp"))

__all__ = ["Publisher", "Publishers", *classes(Publishers, "yarp")]
