"""The 33 bytes that go along with messages of ROS 2."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import DecodeError
from yarpy.peers.ros2.zenoh.attachment import SIZE, attachment, parse_attachment

ext = pytest.importorskip("zenoh.ext", reason='Zenoh: pip install "yarpy[zenoh]"')
GID = bytes.fromhex("f15f21d2fafc22891bb0db868309bfcb")


def test_golden_bytes() -> None:
    """As `zenoh.ext` spells (Int64, Int64, bytes), which the RMW uses."""
    when = 1_700_000_000_123_456_789
    data = attachment(1, when, GID)
    assert data.hex() == "0100000000000000" + "15cd853dfe9c9717" + "10" + GID.hex()
    assert data == bytes(ext.z_serialize((ext.Int64(1), ext.Int64(when), GID)))
    assert len(data) == SIZE == 33
    assert parse_attachment(data) == (1, when, GID)


def _sized(data: bytes) -> bytes:
    """The same with the size of a GID in its place."""
    return data[:16] + b"\x10" + data[16:]


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "does not come from a node"),
        (bytes(32), "does not come from a node"),
        (bytes(80), "older than 0.1.2"),
        (bytes(33), "GID of 0 bytes"),
    ],
)
def test_what_is_wrong(data: bytes, says: str) -> None:
    with pytest.raises(DecodeError, match=says):
        parse_attachment(data)


@given(st.binary(max_size=40) | st.binary(min_size=32, max_size=32).map(_sized))
def test_any_bytes(data: bytes) -> None:
    try:
        assert attachment(*parse_attachment(data)) == data
    except DecodeError:
        pass
