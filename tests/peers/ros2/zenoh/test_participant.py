"""Our part in the graph: tokens come and go with endpoints, the session with the last of them."""

import logging
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.errors import LinkClosed
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.zenoh.participant import Participant, take_part
from yarpy.peers.zenoh.transport import share

ARM = Node("/robot", "arm")
KEY = Key(3, "/pose", "std_msgs::msg::dds_::String_", "TypeHashNotSupported")


@pytest.fixture
def part(router: int) -> Iterator[Participant]:
    found = take_part(3)
    yield found
    found.close()


def texts(part: Participant) -> list[str]:
    return sorted(str(token) for token in part.graph.tokens)


def test_tokens_of_a_node(part: Participant) -> None:
    one = part.declare("MP", ARM, KEY, Qos())
    one.show()
    two = part.declare("MS", ARM, KEY, Qos(), "backends:cpu:")
    two.show()
    wait_until(lambda: len(texts(part)) == 3)
    zid = part.shared.zid
    said = f"@ros2_lv/3/{zid}/0"
    where = "%/%robot/arm"
    pose = "%pose/std_msgs::msg::dds_::String_/TypeHashNotSupported/::,10:,:,:,,"
    assert texts(part) == [
        f"{said}/0/NN/{where}",
        f"{said}/1/MP/{where}/{pose}",
        f"{said}/2/MS/{where}/{pose}/backends:cpu:",
    ]
    one.close()
    one.close()
    wait_until(lambda: len(texts(part)) == 2)
    two.close()
    wait_until(lambda: texts(part) == [], what="the node goes with its last endpoint")


def test_domains_are_apart_and_sessions_are_shared(part: Participant) -> None:
    again, other = take_part(3), take_part(4)
    assert again is part
    assert other is not part
    assert other.session is part.session
    declared = other.declare("MP", ARM, KEY._replace(domain=4), Qos())
    declared.show()
    wait_until(lambda: len(texts(other)) == 2)
    assert texts(part) == []
    declared.close()
    other.close()
    again.close()
    assert not part.session.is_closed()


def test_the_session_ends_with_the_last(router: int) -> None:
    part = take_part(5)
    session = part.session
    part.close()
    assert session.is_closed()


def test_two_nodes_of_one_name(part: Participant, caplog: pytest.LogCaptureFixture) -> None:
    with share() as shared:
        text = f"@ros2_lv/3/{'0' * 32}/0/0/NN/%/%robot/arm"
        token = shared.session.liveliness().declare_token(text)
        wait_until(lambda: len(texts(part)) == 1)
        with caplog.at_level(logging.WARNING, logger="yarpy"):
            declared = part.declare("MP", ARM, KEY, Qos())
            declared.show()
        assert "another node of ROS 2 is called /robot/arm already" in caplog.text
        declared.close()
        token.undeclare()  # type: ignore[no-untyped-call]


def test_no_router(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
    monkeypatch.setenv("YARPY_ZENOH", "127.0.0.1:9")
    with pytest.raises(LinkClosed, match=r"127\.0\.0\.1:9"):
        take_part(0)
