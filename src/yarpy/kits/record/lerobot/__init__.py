"""Data sets of LeRobot, written from recordings."""
