"""Frames: what is seen from where, what is refused, what is forgotten."""

from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from yarpy.kits.devices.transforms.frames import LONGEST, MOST, Frames, matrix, transform
from yarpy.kits.devices.transforms.functions import Transform

QUARTER = (0.0, 0.0, sqrt(0.5), sqrt(0.5))  # to the left, around z


@pytest.fixture
def frames() -> Frames:
    made = Frames()
    made.place("head", "base", (0.5, 1.5, 2.5), constant=True)
    made.place("eye", "head", (0.25, 0, 0), QUARTER, constant=True)
    made.place("hand", "base", (1, 0, 0), constant=True)
    return made


def test_what_is_seen_from_where(frames: Frames) -> None:
    eye = frames.pose("eye", "base")
    assert np.allclose(eye[:3, 3], (0.75, 1.5, 2.5))
    assert np.allclose(eye[:3, :3], ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
    assert np.allclose(frames.pose("base", "eye") @ eye, np.eye(4))
    assert np.allclose(frames.pose("hand", "head")[:3, 3], (0.5, -1.5, -2.5))
    assert np.allclose(frames.pose("eye", "eye"), np.eye(4))
    assert np.allclose(frames.pose("hand", "eye") @ [0, 0, 0, 1], (-1.5, -0.25, -2.5, 1))


def test_rotations() -> None:
    """Around x, against what the angle says; of any length."""
    angle = pi / 5
    for length in (1.0, 3.0):
        rotation = (length * sin(angle / 2), 0.0, 0.0, length * cos(angle / 2))
        found = matrix(transform("a", "b", (0, 0, 0), rotation, False, 0.0))
        c, s = cos(angle), sin(angle)
        assert np.allclose(found[:3, :3], ((1, 0, 0), (0, c, -s), (0, s, c)))


def test_what_is_not_connected(frames: Frames) -> None:
    frames.place("cup", "table", constant=True)
    with pytest.raises(LookupError, match='nothing connects "cup" with "eye"'):
        frames.pose("cup", "eye")
    with pytest.raises(LookupError, match='no frame "nose", there are base, cup, eye'):
        frames.pose("nose", "base")
    with pytest.raises(LookupError, match="there are none"):
        Frames().pose("a", "b")


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("a", "a"), "not the same"), (("", "a"), "not the same"), (("a", ""), "not the same"),
        (("a", "b", (0, 0)), "three numbers"), (("a", "b", (0, 0, 0), (0, 0, 1)), "three numbers"),
        (("a", "b", (float("nan"), 0, 0)), "finite"),
        (("a", "b", (0, 0, 0), (0, 0, 0, 0)), "not 0"),
        (("a", "b", (0, 0, 0), (1e200, 1e308, 0, 0)), "not 0"),
        (("base", "eye"), "its own parent"),
    ],
)  # fmt: skip
def test_what_is_refused(frames: Frames, arguments: tuple, why: str) -> None:
    before = frames.all()
    with pytest.raises(ValueError, match=why):
        frames.place(*arguments)
    assert frames.all() == before


def test_all_or_none(frames: Frames) -> None:
    with pytest.raises(ValueError, match="not the same"):
        frames.add([Transform("base", "new", 1e12), Transform("x", "x")])
    assert "new" not in {each.target for each in frames.all()}


def test_there_is_a_limit() -> None:
    frames = Frames()
    with pytest.raises(ValueError, match=f"more than {MOST} frames"):
        frames.add(Transform("base", str(number), 1e12) for number in range(MOST + 1))
    with pytest.raises(ValueError, match=f"more than {LONGEST} frames in a row"):
        frames.add(Transform(str(number), str(number + 1), 1e12) for number in range(2 * LONGEST))
    frames.add(Transform("base", str(number), 1e12) for number in range(MOST))
    assert len(frames.all()) == MOST


def test_what_moves_is_forgotten() -> None:
    now = [100.0]
    frames = Frames(0.2, lambda: now[0])
    frames.place("head", "base", constant=True)
    frames.place("hand", "base")
    assert [each.target for each in frames.all()] == ["head", "hand"]
    now[0] += 0.15
    frames.place("eye", "head")
    now[0] += 0.1
    assert [each.target for each in frames.all()] == ["head", "eye"]
    assert frames.remove("head", "base") and not frames.remove("head", "base")
    assert not frames.remove("eye", "base")
    frames.clear()
    assert frames.all() == []
