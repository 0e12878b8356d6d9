"""Robots of a MuJoCo model: what they look like, how they move and what they sense."""
