"""Steering: an agent that sees how connections are doing and changes their priorities (autoqos)."""
