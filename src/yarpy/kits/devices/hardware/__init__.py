"""Devices of hardware, without C++: a file for each kind."""
