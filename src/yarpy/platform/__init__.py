"""Differences of operating systems: one file for each, with what every system has for it."""
