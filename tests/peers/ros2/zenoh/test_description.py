"""Nodes that are asked what their types look like."""

import logging
from typing import Any

import pytest
from peers.ros2.message.test_description import description_of
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.message.description import SERVICE
from yarpy.peers.ros2.message.library import Library, hash_of
from yarpy.peers.ros2.message.source import Standard
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.zenoh.participant import take_part

Odd: Any = Library(
    [Texts({"p/Odd": "string<=8 name\nint16[2] pair"}, "there"), Standard()]
).message("p/Odd")


@pytest.mark.parametrize("honest", [True, False])
def test_a_type_that_nobody_here_knows(
    names: yarpy.LocalNames,
    honest: bool,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("yarpy.peers.ros2.zenoh.description.TIMEOUT", HANG)

    def describe(message: yarpy.Message) -> object:
        asked = message.ros  # type: ignore[attr-defined]
        if not honest:
            return {"successful": False, "failure_reason": "no such type"}
        assert asked.type_name == "p/msg/Odd"
        return {"successful": True, "type_description": description_of(Odd).to_dict()}

    name = "/odd" if honest else "/strange"
    hash_ = hash_of(Odd) if honest else "RIHS01_" + "0" * 64
    key = Key(0, name, "p::msg::dds_::Odd_", hash_)
    part = take_part(0)
    with (
        yarpy.RpcServer("/server", describe) as server,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        server.listen_to(f"ros2+node.robot/arm://robot/arm/get_type_description~{SERVICE}")
        token = part.declare("MP", Node("/robot", "arm"), key, Qos())
        token.show()
        wait_until(lambda: part.graph.endpoints(name, "MP"))
        if honest:
            reader.listen_to(f"ros2:/{name}")
            body = b"".join(Odd(name="left", pair=[1, 2]).to_ros())
            part.session.put(str(key), body)
            found: Any = reader.read(timeout=HANG)
            assert (found.ros.name, found.ros.pair.tolist()) == ("left", [1, 2])
        else:
            with pytest.raises(yarpy.YarpError, match=r"p/msg/Odd.*; the node /robot/arm says"):
                reader.listen_to(f"ros2:/{name}")
        token.close()
    part.close()
    assert not [row for row in caplog.records if row.levelno >= logging.ERROR]
