"""Frames are a tree with one root."""

import pytest

from yarpy.kits.sim.robot import icub, icub_head


@pytest.mark.parametrize("make", [icub_head, icub])
def test_parents_come_first_and_cameras_are_among_them(make):
    parts = make((32, 32), lambda: 12.5)
    when, frames = parts.frames.frames()
    assert when == 12.5
    known = {"root_link"}
    for frame in frames:
        assert frame.parent in known and frame.name not in known
        known.add(frame.name)
        assert sum(part**2 for part in frame.orientation) == pytest.approx(1.0)
    assert known >= {"head", *parts.cameras}
