"""Launch and keep running: applications (`yarpy up`), programs on other computers, one log."""
