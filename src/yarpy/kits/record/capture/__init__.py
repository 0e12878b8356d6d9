"""Capture: what a recorder takes from ports and writes into files."""
