"""Nodes, topics and services of a domain."""

import pytest

import yarpy
from yarpy.peers.ros2.token import parse_token
from yarpy.peers.ros2.zenoh.listing import Entry, entries, is_used, listing

NODE = "@ros2_lv/0/abc/0/0/NN/%/%robot/arm"
REST = "std_msgs::msg::dds_::String_/TypeHashNotSupported/::,10:,:,:,,"
HEARS = f"@ros2_lv/0/abc/0/1/MS/%/%robot/arm/%goal/{REST}"


def test_entries() -> None:
    texts = (
        NODE,
        HEARS,
        HEARS.replace("/1/MS/", "/2/MP/"),
        HEARS.replace("/MS/", "/SS/").replace("msg::dds_::String", "srv::dds_::Ask"),
        HEARS.replace("std_msgs::msg::dds_::String_", "odd"),
        HEARS.replace("%goal", "%_hidden"),
        NODE.replace("arm", "_ros2cli_1"),
    )
    found = entries(map(parse_token, texts))
    assert found == [
        Entry("node", "/robot/arm", ""),
        Entry("service", "/goal", "std_msgs/srv/Ask"),
        Entry("topic", "/goal", "odd"),
        Entry("topic", "/goal", "std_msgs/msg/String"),
    ]
    assert [item.target for item in found] == [
        "/robot/arm",
        "ros2+srv://goal~std_msgs/srv/Ask",
        "ros2://goal~odd",
        "ros2://goal~std_msgs/msg/String",
    ]


def test_whether_there_is_any() -> None:
    assert not is_used({})
    assert not is_used({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"})
    assert is_used({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"})
    assert is_used({"ZENOH_SESSION_CONFIG_URI": "/etc/zenoh.json5"})
    assert is_used({"YARPY_ZENOH": "router"})


def test_ports_are_listed(names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    with yarpy.Port("/robot/voice") as out, yarpy.Port("/seven") as other:
        out.connect("ros2://robot/chatter~std_msgs/msg/String")
        other.connect("ros2+domain.7://chatter~std_msgs/msg/String")
        chatter = Entry("topic", "/robot/chatter", "std_msgs/msg/String")
        assert listing() == [Entry("node", "/robot/voice", ""), chatter]
        assert listing("/robot/chatter") == [chatter]
        assert listing("/rob") == []
        monkeypatch.setenv("ROS_DOMAIN_ID", "7")
        assert [item.name for item in listing()] == ["/seven", "/chatter"]
