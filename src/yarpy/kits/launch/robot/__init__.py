"""Robots described in the XML of yarprobotinterface: their devices, opened, joined and closed."""
