"""Clients over ZeroMQ: ZeroMQClient, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.clients import Client, Clients

globals().update(classes(Clients, "zeromq"))

__all__ = ["Client", "Clients", *classes(Clients, "zeromq")]
