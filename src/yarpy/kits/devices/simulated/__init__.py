"""Devices without hardware, by the names of C++ YARP: for tests, lessons, and programs to come."""
