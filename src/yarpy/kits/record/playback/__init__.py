"""Playback: a recording sent again, when it is due."""
