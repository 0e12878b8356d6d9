"""The header of a PointCloud."""

import struct

import numpy as np
import pytest

from yarpy.data.sig.cloud_head import HEAD, SIZES, cloud_size, is_likely_cloud, may_be_cloud
from yarpy.data.sig.pointcloud import KINDS, PointCloud

HEADER = HEAD.pack(4, 2, 2, 1, 266, 8)


def test_the_sizes_are_those_of_the_kinds() -> None:
    assert {kind.code: kind.size for kind in KINDS.values()} == SIZES


def test_size() -> None:
    message = b"".join(PointCloud(np.zeros((2, 4, 3))).to_wire())
    assert message.startswith(HEADER)
    assert cloud_size(HEADER) == len(message) == cloud_size(memoryview(message))
    assert cloud_size(HEADER[:-1]) == 0


@pytest.mark.parametrize(
    "head",
    [
        (4, 2, 3, 1, 266, 8),  # a kind of points that there is not
        (4, 2, 2, 2, 266, 8),  # neither dense nor not
        (4, 2, 2, 1, 267, 8),
        (4, 2, 2, 1, 266, 9),
        (-4, -2, 2, 1, 266, 8),
    ],
)
def test_what_is_none(head: tuple[int, ...]) -> None:
    assert cloud_size(struct.pack("<iiibii", *head)) == 0


def test_beginnings() -> None:
    assert all(may_be_cloud(HEADER[:size]) for size in range(9, 22))
    assert not may_be_cloud(HEADER[:8] + b"\x03")
    assert not any(is_likely_cloud(HEADER[:size]) for size in range(12, 16))
    assert all(is_likely_cloud(HEADER[:size]) for size in range(16, 22))
    assert not may_be_cloud(HEADER[:12] + b"\x07")
    assert not may_be_cloud(HEADER[:13] + b"\x0b")
    assert not is_likely_cloud(struct.pack("<4i", 256, 1, 1, 5))
