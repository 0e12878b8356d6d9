"""dynamic_reconfigure, from both sides: a service and two topics of types that come with yarpy."""

from __future__ import annotations

from typing import Any

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.peers.ros.node.node import Node

pytestmark = pytest.mark.peer("dynamic_reconfigure")

SERVER = """
import rospy
from dynamic_reconfigure.server import Server
from dynamic_reconfigure.cfg import TestConfig
rospy.init_node("camera", disable_signals=True)
def changed(config, level):
    print("set", config.int_, config.double_, config.str_, config.bool_, flush=True)
    return config
Server(TestConfig, changed)
print("ready", flush=True)
rospy.spin()
"""
CLIENT = """
import rospy
from dynamic_reconfigure.client import Client
rospy.init_node("tuner", disable_signals=True)
client = Client("/ours", timeout=60)
print("has", client.get_configuration(60)["gain"], flush=True)
print("set", client.update_configuration({"gain": "2.5"})["gain"], flush=True)
"""


def values(config: Any) -> dict[str, Any]:
    """The parameters of a Config."""
    kinds = (config.bools, config.ints, config.strs, config.doubles)
    return {each.name: each.value for kind in kinds for each in kind}


def test_a_server_of_ros(graph: RosGraph) -> None:
    with graph.python(SERVER) as server, Node("/asking") as node:
        server.wait_line("ready")
        updates = node.subscriber("/camera/parameter_updates", "dynamic_reconfigure/Config")
        assert values(updates.take(timeout=HANG))["double_"] == 0.0
        described = node.subscriber(
            "/camera/parameter_descriptions", "dynamic_reconfigure/ConfigDescription"
        ).take(timeout=HANG)
        assert values(described.max)["int_"] == 10
        assert "int_" in [each.name for each in described.groups[0].parameters]
        change = {
            "ints": [{"name": "int_", "value": 40}],  # 10 is the most
            "doubles": [{"name": "double_", "value": 1.5}],
            "strs": [{"name": "str_", "value": "fast"}],
            "bools": [{"name": "bool_", "value": True}],
        }
        service = "/camera/set_parameters"
        answer = node.call(service, "dynamic_reconfigure/Reconfigure", {"config": change})
        server.wait_line("set 10 1.5 fast True")
        now = values(answer.config)
        assert (now["int_"], now["double_"], now["str_"], now["bool_"]) == (10, 1.5, "fast", True)
        assert values(updates.take(timeout=HANG)) == now
        assert node.get_param("/camera/str_") == "fast"


def test_a_client_of_ros(graph: RosGraph) -> None:
    gain = {"name": "gain", "value": 1.0}
    whole = {"name": "Default", "state": True, "id": 0, "parent": 0}

    def config(value: float) -> dict[str, Any]:
        return {"doubles": [{**gain, "value": value}], "groups": [whole]}

    with Node("/ours") as node:
        kind = "dynamic_reconfigure/ConfigDescription"
        descriptions = node.publisher("~parameter_descriptions", kind, latch=True)
        parameter = {"name": "gain", "type": "double", "level": 1, "description": "of the loop"}
        group = {"name": "Default", "parameters": [parameter], "parent": 0, "id": 0}
        bounds = {"min": config(0.0), "max": config(9.0), "dflt": config(1.0)}
        descriptions.write({"groups": [group], **bounds})
        updates = node.publisher("~parameter_updates", "dynamic_reconfigure/Config", latch=True)
        updates.write(config(1.0))
        asked: list[Any] = []

        def change(question: Any) -> Any:
            asked.append(values(question.config))
            return {"config": config(asked[-1]["gain"])}

        node.service("~set_parameters", "dynamic_reconfigure/Reconfigure", change)
        with graph.python(CLIENT) as client:
            client.wait_line("has 1.0")
            client.wait_line("set 2.5")
        wait_until(lambda: asked == [{"gain": 2.5}], HANG, "the change is asked for")
