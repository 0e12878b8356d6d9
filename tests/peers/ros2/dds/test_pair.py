"""The bytes of questions and answers, and where they go."""

from queue import Queue
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.peers.ros2.dds import pair as module
from yarpy.peers.ros2.dds.pair import Pair, ServiceSample, joined, parted, topics
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.message.library import default_library
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos

# who: 0x0102030405060708, number: 7, then the int64 5 and 37
QUESTION = bytes.fromhex("000100000807060504030201070000000000000005000000000000002500000000000000")


def test_golden_bytes() -> None:
    kind = default_library().service("example_interfaces/AddTwoInts")
    body = b"".join(kind.Request(a=5, b=37).to_ros())
    assert joined(0x0102030405060708, 7, body) == QUESTION
    assert parted(QUESTION, 3) == ServiceSample(0x0102030405060708, 7, body, 3)
    assert topics("/robot/add") == ("rq/robot/addRequest", "rr/robot/addReply")


@pytest.mark.parametrize("body", [b"", QUESTION[:19], b"\0\0" + QUESTION[2:]])
def test_what_is_no_question(body: bytes) -> None:
    assert parted(body, 0) is None


def test_nothing_but_a_header() -> None:
    sample = parted(QUESTION[:20], 0)
    assert sample is not None and sample.body == b"\0\1\0\0"


def test_an_answer_waits_for_its_reader(
    here: None, own: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be known later than the writer of the question; one that never comes is waited for
    once."""
    kind = default_library().service("example_interfaces/AddTwoInts")
    part, node = POOL.take(0), Node("/", own[1:])
    answered: Queue[ServiceSample] = Queue()
    asked: Queue[ServiceSample] = Queue()
    server = Pair(part, node, own, kind, Qos(), True, asked.put)
    client = Pair(part, node, own, kind, Qos(), False, answered.put)
    try:
        wait_until(lambda: bool(client.servers()))
        looked = []

        def late(half: object, what: str, real: Any = server._matching) -> list[Any]:
            looked.append(what)
            return real(half, what) if len(looked) > 3 else []

        monkeypatch.setattr(server, "_matching", late)
        client.write(client.who, 1, b"\0\1\0\0" + bytes(16))
        question = asked.get(timeout=HANG)
        server.answer(question, b"\0\1\0\0" + bytes(8))
        assert answered.get(timeout=HANG).number == 1 and len(looked) == 4
        server.answer(question, b"\0\1\0\0" + bytes(8))
        assert answered.get(timeout=HANG).number == 1 and len(looked) == 4
        monkeypatch.setattr(server, "_matching", lambda half, what: looked.append(what) or [])
        monkeypatch.setattr(module, "MEETING", 0.02)
        server._met.clear()
        server.answer(question, b"\0\1\0\0" + bytes(8))
        assert answered.get(timeout=HANG).number == 1 and len(looked) > 4
        assert server._is_met(0)  # it has gone
    finally:
        client.close()
        server.close()
        POOL.leave(part)
