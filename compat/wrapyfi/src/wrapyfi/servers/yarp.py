"""Servers over YARP: YarpServer, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.servers import Server, Servers

globals().update(classes(Servers, "yarp"))

__all__ = ["Server", "Servers", *classes(Servers, "yarp")]
