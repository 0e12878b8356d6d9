"""Where things of the world are in a picture."""

import numpy as np
import pytest

from yarpy.kits.sim.head import Pose
from yarpy.kits.sim.render.lens import NOWHERE, Box, Lens, around

# A camera at the origin of the world that looks along x; its own x is to the right.
AHEAD = Pose(((0, 0, 1), (-1, 0, 0), (0, -1, 0)), (0, 0, 0))
LENS = Lens(64, 48, 50.0)


def inverses(*surfaces):
    u, v, corner = (np.array(part, float) for part in zip(*surfaces, strict=True))
    return np.linalg.inv(LENS.matrices(AHEAD, u, v, corner))


def test_boxes():
    one, other = Box(0, 0, 10, 10), Box(5, 5, 20, 8)
    assert one.common(other) == Box(5, 5, 10, 8)
    assert one.common(Box(10, 0, 12, 10)).empty
    assert around(one, other) == Box(0, 0, 20, 10)
    assert around(one, NOWHERE) == around(NOWHERE, one) == one
    picture = np.arange(100).reshape(10, 10)
    assert Box(2, 3, 4, 5).of(picture).tolist() == [[32, 33], [42, 43]]


def test_points():
    x, y, depth = LENS.point(AHEAD, (2.0, -0.5, 0.25))
    assert (x, y, depth) == pytest.approx((31.5 + 12.5, 23.5 - 6.25, 2.0))


def test_spans_of_a_square():
    """One metre wide, two metres away: 25 pixels around the middle."""
    [left], [right] = (lambda spans: (spans.left, spans.right))(
        LENS.spans(inverses(((0, -1, 0), (0, 0, 1), (2, 0.5, -0.5))))
    )
    assert (left[24], right[24]) == (19, 45)
    shown = np.flatnonzero(left < right)
    assert (shown[0], shown[-1]) == (11, 36)
    assert set(left[shown]) == {19} and set(right[shown]) == {45}


def test_spans_agree_with_asking_each_pixel():
    chance = np.random.default_rng(5)
    surfaces = [
        (chance.normal(size=3), chance.normal(size=3), chance.normal((1.5, 0, 0)))
        for _ in range(60)
    ]
    found = inverses(*surfaces)
    spans = LENS.spans(found)
    y, x = np.indices((48, 64))
    seen = 0
    for matrix, left, right, box in zip(found, spans.left, spans.right, spans.boxes, strict=True):
        a, b, depth = np.einsum("ij,jyx->iyx", matrix, [x, y, np.ones_like(x)])
        inside = (a >= 0) & (b >= 0) & (a <= depth) & (b <= depth)
        ours = (x >= left[:, None]) & (x < right[:, None])
        assert (inside != ours).sum() <= 2, "but for rounding"
        seen += inside.sum()
        if ours.any():
            rows, columns = np.nonzero(ours)
            assert box == Box(columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
        else:
            assert box.empty
    assert seen > 10_000


def test_edges_along_the_rows():
    spans = LENS.spans(inverses(((0, -9, 0), (0, 0, 1), (2, 4, 0))))
    assert spans.boxes == [Box(0, 0, 64, 24)]


def test_what_is_certainly_not_seen():
    ahead, behind, far_left = (2, 0, 0), (-2, 0, 0), (1, 9, 0)
    matrices = LENS.matrices(
        AHEAD, np.array([(0, -1, 0)] * 3), np.array([(0, 0, 1)] * 3),
        np.array([ahead, behind, far_left], float),
    )  # fmt: skip
    assert LENS.candidates(matrices).tolist() == [0]


def test_parts_of_spans():
    spans = LENS.spans(inverses(((0, -1, 0), (0, 0, 1), (2, 0.5, -0.5))))
    left, right = spans.within(Box(0, 20, 30, 22))
    assert (left < right).nonzero()[1].tolist() == [20, 21]
    assert (left[0, 20], right[0, 20]) == (19, 30)


def test_bounds():
    matrices = LENS.matrices(
        AHEAD, np.array([(0, -1, 0)] * 2), np.array([(0, 0, 1)] * 2),
        np.array([(2, 0.5, -0.5), (-1, 0, 0)], float),
    )  # fmt: skip
    box = LENS.bounds(matrices[0])
    assert box.common(Box(19, 11, 45, 37)) == Box(19, 11, 45, 37)
    assert LENS.bounds(matrices[1]).empty
