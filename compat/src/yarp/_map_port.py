"""Ports of maps and of what is in them: BufferedPortMap2DLocation and its like, of YARP 4."""

from __future__ import annotations

from yarp._buffered_port import BufferedPort, Callback
from yarp._map_grid import MapGrid2D
from yarp._map_place import Map2DArea, Map2DLocation, Map2DPath
from yarp._typed_reader import TypedReader


class TypedReaderMap2DLocation(TypedReader[Map2DLocation]):
    datum = Map2DLocation


class TypedReaderMap2DArea(TypedReader[Map2DArea]):
    datum = Map2DArea


class TypedReaderMap2DPath(TypedReader[Map2DPath]):
    datum = Map2DPath


class TypedReaderMapGrid2D(TypedReader[MapGrid2D]):
    datum = MapGrid2D


class BufferedPortMap2DLocation(BufferedPort[Map2DLocation], TypedReaderMap2DLocation):
    datum = Map2DLocation


class BufferedPortMap2DArea(BufferedPort[Map2DArea], TypedReaderMap2DArea):
    datum = Map2DArea


class BufferedPortMap2DPath(BufferedPort[Map2DPath], TypedReaderMap2DPath):
    datum = Map2DPath


class BufferedPortMapGrid2D(BufferedPort[MapGrid2D], TypedReaderMapGrid2D):
    datum = MapGrid2D


class Map2DLocationCallback(Callback):
    """Of a BufferedPortMap2DLocation."""


class Map2DAreaCallback(Callback):
    """Of a BufferedPortMap2DArea."""


class Map2DPathCallback(Callback):
    """Of a BufferedPortMap2DPath."""


class MapGrid2DCallback(Callback):
    """Of a BufferedPortMapGrid2D."""
