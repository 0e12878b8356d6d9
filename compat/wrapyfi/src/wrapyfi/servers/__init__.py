"""Servers of all middlewares, by the names that Wrapyfi gives their modules and classes."""

from __future__ import annotations

from wrapyfi.connect.servers import FallbackServer, Server, Servers

__all__ = ["FallbackServer", "Server", "Servers"]
