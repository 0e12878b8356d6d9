"""Following a topic that comes later, goes away and comes back."""

from __future__ import annotations

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.wrap.follower import Follower


def test_topic_that_comes_later_and_returns(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("") as port:
        follower = Follower(port, "/topic")
        assert not follower.connected and not follower.wait(0.01)
        for word in ("first", "second"):
            with yarpy.Port("/topic") as topic:
                assert follower.wait(HANG)
                wait_until(lambda topic=topic: topic.outputs)  # of this one, not of its predecessor
                assert topic.write(word) == 1
                assert port.read(HANG).value == word
            wait_until(lambda: not follower.connected)
        follower.close()


def test_what_can_never_work_is_an_error_at_once(names: yarpy.LocalNames) -> None:
    port = yarpy.BufferedPort("")
    with port, yarpy.Port("/topic"), pytest.raises(yarpy.UnknownPlugin, match="tpc"):
        Follower(port, "/topic", "tpc")


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_priorities_are_given(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("") as port, yarpy.Port("/topic"):
        follower = Follower(port, "/topic", qos=yarpy.Qos(packets="HIGH"))
        assert follower.wait(HANG)
        wait_until(lambda: [link.qos.packets for link in port.inputs] == ["AF42"])
        follower.close()


def test_topic_that_is_gone_before_anybody_waits(names: yarpy.LocalNames) -> None:
    """Its message is there, so waiting on would be for ever."""
    with yarpy.BufferedPort("") as port:
        with yarpy.Port("/topic") as topic:
            follower = Follower(port, "/topic")
            assert topic.write("last words") == 1
        wait_until(lambda: not follower.connected)
        assert follower.wait(0.0) and port.read(HANG).value == "last words"
        follower.close()
        assert not follower.wait(0.0)
