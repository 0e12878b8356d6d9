"""Clients over YARP: YarpClient, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.clients import Client, Clients

globals().update(classes(Clients, "yarp"))

__all__ = ["Client", "Clients", *classes(Clients, "yarp")]
