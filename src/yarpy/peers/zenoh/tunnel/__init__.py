"""Streams of bytes through Zenoh, where no TCP connection leads to a port."""
