"""Clients of all middlewares, by the names that Wrapyfi gives their modules and classes."""

from __future__ import annotations

from wrapyfi.connect.clients import Client, Clients, FallbackClient

__all__ = ["Client", "Clients", "FallbackClient"]
