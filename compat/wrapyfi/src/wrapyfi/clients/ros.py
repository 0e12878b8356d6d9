"""Clients over ROS: ROSClient, and one of each type."""

from __future__ import annotations

from wrapyfi.connect._named import classes
from wrapyfi.connect.clients import Client, Clients

globals().update(classes(Clients, "ros"))

__all__ = ["Client", "Clients", *classes(Clients, "ros")]
