"""Which type a topic has."""

import pytest

import yarpy
from yarpy.errors import DecodeError, UnknownType
from yarpy.peers import ros2
from yarpy.peers.ros2.key import NO_HASH
from yarpy.peers.ros2.kind import (
    MOST_ASKED,
    chosen,
    has_bytes,
    humble,
    key_of,
    learned,
    named,
    shown,
)
from yarpy.peers.ros2.message.library import Library, default_library, hash_of
from yarpy.peers.ros2.message.source import Rosbags
from yarpy.peers.ros2.token import Token, parse_token

HUMBLE_RANGE = hash_of(Library([Rosbags("humble")]).message("sensor_msgs/Range"))
String = ros2.load("std_msgs/msg/String")


def token(type_: str, hash_: str) -> Token:
    return parse_token(f"@ros2_lv/0/abc/0/1/MP/%/%/node/%topic/{type_}/{hash_}/::,10:,:,:,,")


def nobody(token: Token, name: str, kind: str) -> None:
    raise UnknownType("its node says nothing")


def test_what_the_user_says() -> None:
    assert named("std_msgs/msg/String", "msg") is String
    assert named("std_srvs/Trigger", "srv") is ros2.load("std_srvs/srv/Trigger")
    theirs = token("sensor_msgs::msg::dds_::Range_", HUMBLE_RANGE)
    assert hash_of(named("sensor_msgs/Range", "msg", [theirs])) == HUMBLE_RANGE
    unknown = token("std_msgs::msg::dds_::String_", "RIHS01_" + "0" * 64)
    assert named("std_msgs/String", "msg", [unknown]) is String
    assert named("std_msgs/String", "msg", old=True) is humble().message("std_msgs/String")


def test_what_the_graph_says() -> None:
    assert learned([], "msg", nobody) is None
    found = learned([token("sensor_msgs::msg::dds_::Range_", HUMBLE_RANGE)], "msg", nobody)
    assert found is not None
    assert hash_of(found[0]) == HUMBLE_RANGE
    old = learned([token("std_msgs::msg::dds_::String_", NO_HASH)], "msg", nobody)
    assert old is not None
    assert old[0] is humble().message("std_msgs/String")
    strange = token("std_msgs::msg::dds_::String_", "RIHS01_" + "0" * 64)
    good = token("std_msgs::msg::dds_::String_", hash_of(String))
    assert learned([token("nonsense", "x"), strange, good], "msg", nobody) == (String, good.key)
    assert learned([good], "srv", nobody) is None
    with pytest.raises(UnknownType, match="there and"):
        learned([strange], "msg", nobody)
    found = learned([strange], "msg", lambda token, name, kind: (name, kind))
    assert found == (("std_msgs/String", "msg"), strange.key)
    with pytest.raises(UnknownType, match="p/msg/T"):
        learned([token("p::msg::dds_::T_", hash_of(String))], "msg", nobody)


def test_who_says_no_version_is_not_taken_for_one_of_jazzy() -> None:
    with pytest.raises(UnknownType, match=r"add ~turtlesim/msg/Pose to the target"):
        learned([token("turtlesim::msg::dds_::Pose_", NO_HASH)], "msg", nobody)
    with pytest.raises(UnknownType) as unknown:
        learned([token("p::msg::dds_::T_", NO_HASH)], "msg", nobody)
    assert "to the target" not in str(unknown.value)


def test_of_a_flood_of_unknown_types_few_nodes_are_asked() -> None:
    asked: list[Token] = []

    def ask(token: Token, name: str, kind: str) -> None:
        asked.append(token)
        raise UnknownType("its node says nothing")

    flood = [token("std_msgs::msg::dds_::String_", f"RIHS01_{at:064x}") for at in range(5000)]
    good = token("std_msgs::msg::dds_::String_", hash_of(String))
    assert learned([*flood, good], "msg", ask) == (String, good.key)
    assert asked == flood[:MOST_ASKED]


@pytest.mark.parametrize(
    ("kind", "type_"), [("srv", "Fibonacci_SendGoal_"), ("msg", "Fibonacci_FeedbackMessage_")]
)
def test_parts_of_actions_are_types_as_others(kind: str, type_: str) -> None:
    known = ros2.load(f"example_interfaces/action/{type_[:-1]}")
    of_action = token(f"example_interfaces::action::dds_::{type_}", hash_of(known))
    assert learned([of_action], kind, nobody) == (known, of_action.key)
    assert learned([of_action], "msg" if kind == "srv" else "srv", nobody) is None
    other = token(f"example_interfaces::action::dds_::{type_}", "RIHS01_" + "0" * 64)
    with pytest.raises(UnknownType, match=r"example_interfaces/action/Fibonacci_"):
        learned([other], kind, nobody)


def test_what_is_written() -> None:
    assert chosen("hi") is chosen(yarpy.Bottle(["hi"])) is String
    own = default_library().message_of("own_msgs/Text", "string data")
    assert chosen(own(data="hi")) is own
    for numbers in (yarpy.Vector([1.0]), yarpy.Bottle([1.0, 2.5]), [1, 2]):
        assert chosen(numbers) is ros2.load("std_msgs/Float64MultiArray")
    for value in (yarpy.Bottle([1, "a"]), yarpy.Bottle(), {"a": 1}, None):
        with pytest.raises(DecodeError, match="ros2://TOPIC~package/msg/Type"):
            chosen(value)


def test_keys() -> None:
    key = key_of(0, "/chatter", String, False)
    assert str(key) == f"0/chatter/std_msgs::msg::dds_::String_/{hash_of(String)}"
    assert str(key_of(0, "/chatter", String, True)).endswith("/TypeHashNotSupported")
    add = key_of(2, "/add", ros2.load("example_interfaces/srv/AddTwoInts"), False)
    assert add.type == "example_interfaces::srv::dds_::AddTwoInts_"
    assert shown(key) == f"std_msgs/msg/String ({hash_of(String)})"
    assert shown(key._replace(type="x")) == f"x ({hash_of(String)})"


def test_pictures_have_bytes() -> None:
    assert has_bytes(ros2.load("sensor_msgs/msg/Image"))
    assert not has_bytes(String)
