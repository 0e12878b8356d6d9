"""The log of a node, as others hear it."""

import logging
from typing import Any

import pytest
from support.wait import wait_until

import yarpy
from yarpy.errors import AddressError
from yarpy.peers import ros2
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.node.rosout import QOS, TOPIC, TYPE, Rosout, node_logger


def test_what_others_hear(names: yarpy.LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    heard: list[Any] = []
    with ros2.Node("/robot/arm") as arm, ros2.Node("/console") as console:
        arm.logger.info("before %s", "anybody hears")
        console.subscriber(TOPIC, TYPE, heard.append, qos=QOS)
        wait_until(lambda: heard)  # where a new one overtakes what is kept, Zenoh drops the latter
        arm.logger.debug("nobody wants this")
        try:
            raise ValueError("too far")
        except ValueError:
            arm.logger.exception("it moved")
        wait_until(lambda: len(heard) >= 2)
        first, second = heard[:2]
        assert (first.level, first.name, first.msg) == (20, "robot.arm", "before anybody hears")
        assert first.stamp.sec > 1e9 and first.file == __file__ and first.line > 0
        assert (second.level, second.msg) == (40, "it moved: ValueError('too far')")
        assert first.function == "test_what_others_hear"
    assert "it moved" in caplog.text


def test_levels() -> None:
    assert node_logger(Node("/", "arm")).isEnabledFor(logging.INFO)
    assert not node_logger(Node("/", "arm")).isEnabledFor(logging.DEBUG)
    assert node_logger(Node("/", "arm"), "DEBUG").isEnabledFor(logging.DEBUG)
    with pytest.raises(AddressError, match="debug, info, warn"):
        node_logger(Node("/", "arm"), "loud")


def test_what_cannot_be_told(capsys: pytest.CaptureFixture[str]) -> None:
    def refuse(value: object) -> None:
        raise ValueError("closed")

    found = node_logger(Node("/", "arm"))
    found.propagate = False
    found.addHandler(Rosout(refuse))
    found.info("hello")  # the program goes on
    assert "ValueError: closed" in capsys.readouterr().err
