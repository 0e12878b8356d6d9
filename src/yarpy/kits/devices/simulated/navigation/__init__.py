"""Simulated devices that know a map: a base that drives in it, lasers, and what keeps maps."""
