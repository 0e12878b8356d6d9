"""Following a topic that comes later, goes away and comes back."""

from __future__ import annotations

import pytest
from support.patience import patience
from support.wait import wait_until

import yarpy
from yarpy.wrap.follower import Follower

PATIENCE = patience(10.0)


def test_topic_that_comes_later_and_returns(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("") as port:
        follower = Follower(port, "/topic")
        assert not follower.connected and not follower.wait(0.01)
        for word in ("first", "second"):
            with yarpy.Port("/topic") as topic:
                assert follower.wait(PATIENCE)
                wait_until(lambda topic=topic: topic.outputs)  # of this one, not of its predecessor
                assert topic.write(word) == 1
                assert port.read(PATIENCE).value == word
            wait_until(lambda: not follower.connected)
        follower.close()


def test_what_can_never_work_is_an_error_at_once(names: yarpy.LocalNames) -> None:
    port = yarpy.BufferedPort("")
    with port, yarpy.Port("/topic"), pytest.raises(yarpy.UnknownPlugin, match="tpc"):
        Follower(port, "/topic", "tpc")


def test_priorities_are_given(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("") as port, yarpy.Port("/topic"):
        follower = Follower(port, "/topic", qos=yarpy.Qos(packets="HIGH"))
        assert follower.wait(PATIENCE)
        wait_until(lambda: port.inputs[0].qos.packets == "AF42")
        follower.close()
