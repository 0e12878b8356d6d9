"""Points of areas, under the names that programs use."""

from __future__ import annotations

import pytest

import yarp
import yarpy


def test_an_area_is_made_of_points() -> None:
    area = yarp.Map2DArea()
    area.points = yarp.Vector2DVector()
    for corner in (yarp.Vector2D(0.0, 0.0), yarp.Vector2D(2, 0), (2, 2)):
        area.points.push_back(corner)
    assert area.points.size() == 3 and area.points.get(1).x == 2.0
    assert area.isEqual(yarp.Map2DArea("", [(0, 0), (2, 0), (2, 2)]))
    assert area.checkLocationInsideArea(yarp.Map2DLocation("", 1.5, 0.5, 0))
    assert area[2] == (2.0, 2.0) and area[2] == yarp.Vector2D(2, 2) and area[2] != "22"
    sent = b"".join(map(bytes, area._outgoing().to_wire()))
    read = yarp.Map2DArea._from(yarpy.Message("D", sent))
    assert isinstance(read.points, yarp.Vector2DVector) and read.isEqual(area)


def test_points_are_numbers() -> None:
    points = yarp.Vector2DVector(2)
    points.resize(3, (4.0, 5.0))
    points[0].x = 7.0
    assert [tuple(point) for point in points] == [(7.0, 0.0), (0.0, 0.0), (4.0, 5.0)]
    assert repr(points[2]) == "(4.0, 5.0)" and points[2][1] == 5.0
    with pytest.raises((TypeError, ValueError)):
        points.push_back("no point")
