"""What carriers have in common that another middleware carries; `test_ros2`, `test_zenoh` do it."""

import pytest
from support.guest import guest

from yarpy.carriers.hosted import Hosted, failure
from yarpy.errors import LocalProtocolError
from yarpy.link.begin.handshake import find_carrier
from yarpy.route import parse_carrier
from yarpy.wire.message import CALL

guest("ros2", "zenoh")
from yarpy.peers.ros2.carrier import Ros2  # noqa: E402
from yarpy.peers.zenoh.carrier import Zenoh  # noqa: E402


@pytest.mark.parametrize("carrier", [Ros2, Zenoh])
def test_additions_choose_the_role(carrier: type[Hosted]) -> None:
    reader, asker, server = carrier.roles()
    found = {
        words: carrier.of(parse_carrier(carrier.name + words))
        for words in ("", "+sub", "+srv", "+srv+sub")
    }
    assert found == {"": carrier, "+sub": reader, "+srv": asker, "+srv+sub": server}
    assert (reader.push, asker.push, server.push) == (False, True, False)
    assert (reader.replies, asker.replies, server.replies) == (False, True, True)


@pytest.mark.parametrize(
    "text",
    ["zenoh+foo", "zenoh+prio.9", "zenoh+qos.all", "zenoh+dds", "ros2+foo", "ros2+raw", "ros2+"],
)
def test_unknown_additions_are_refused(text: str) -> None:
    with pytest.raises(
        LocalProtocolError, match=r'(zenoh|ros2) knows no "\+\w*", but \+srv, \+sub'
    ):
        find_carrier(parse_carrier(text))


@pytest.mark.parametrize(
    "text",
    [
        "zenoh+srv+sub+raw",
        "zenoh+send.throttle+period_ms.10",
        "ros2+domain.7+node.arm+qos.sensor+dds+sub",
        "ros2+srv+distro.humble+log.in",
    ],
)
def test_known_additions(text: str) -> None:
    assert issubclass(find_carrier(parse_carrier(text)), Hosted)


def test_a_question_without_an_answer() -> None:
    message = failure("nobody is there")
    assert message.key == CALL
    assert message.value == ["fail", "nobody is there"]
