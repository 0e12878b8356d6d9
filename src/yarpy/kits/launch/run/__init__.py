"""Run: starts programs on this computer for those who may, and asks other computers to."""
