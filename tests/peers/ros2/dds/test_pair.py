"""The bytes of questions and answers, and where they go."""

import pytest

from yarpy.peers.ros2.dds.pair import Came, joined, parted, topics
from yarpy.peers.ros2.message.library import default_library

# who: 0x0102030405060708, number: 7, then the int64 5 and 37
QUESTION = bytes.fromhex("000100000807060504030201070000000000000005000000000000002500000000000000")


def test_golden_bytes() -> None:
    kind = default_library().service("example_interfaces/AddTwoInts")
    body = b"".join(kind.Request(a=5, b=37).to_ros())
    assert joined(0x0102030405060708, 7, body) == QUESTION
    assert parted(QUESTION, 3) == Came(0x0102030405060708, 7, body, 3)
    assert topics("/robot/add") == ("rq/robot/addRequest", "rr/robot/addReply")


@pytest.mark.parametrize("body", [b"", QUESTION[:19], b"\0\0" + QUESTION[2:]])
def test_what_is_no_question(body: bytes) -> None:
    assert parted(body, 0) is None


def test_nothing_but_a_header() -> None:
    came = parted(QUESTION[:20], 0)
    assert came is not None and came.body == b"\0\1\0\0"
