"""The types of actions, and what nodes of ROS 2 ask each other, by published hashes."""

import pickle

import pytest

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers import ros2
from yarpy.peers.ros2.message.action import action_name, part_of, plain_name, texts_of
from yarpy.peers.ros2.message.library import Action, Library, hash_of
from yarpy.peers.ros2.message.source import Standard

PUBLISHED = {
    "example_interfaces/action/Fibonacci_Goal": (
        "RIHS01_226cb437e4355dcd3e914f930382a3b0cc1da81545bd319ed554e95a03255f51"
    ),
    "example_interfaces/action/Fibonacci_SendGoal": (
        "RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557"
    ),
    "example_interfaces/action/Fibonacci_GetResult": (
        "RIHS01_1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57"
    ),
    "example_interfaces/action/Fibonacci_FeedbackMessage": (
        "RIHS01_c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2"
    ),
    "action_msgs/srv/CancelGoal": (
        "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"
    ),
    "action_msgs/msg/GoalStatusArray": (
        "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"
    ),
    "rcl_interfaces/srv/ListParameters": (
        "RIHS01_3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d"
    ),
    "rcl_interfaces/srv/GetParameters": (
        "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"
    ),
    "rcl_interfaces/srv/GetParameterTypes": (
        "RIHS01_da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca"
    ),
    "rcl_interfaces/srv/SetParameters": (
        "RIHS01_56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0"
    ),
    "rcl_interfaces/msg/ParameterEvent": (
        "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"
    ),
}


@pytest.mark.parametrize(("name", "hash_"), PUBLISHED.items())
def test_hashes(name: str, hash_: str) -> None:
    assert hash_of(Library([Standard()]).load(name)) == hash_  # type: ignore[arg-type]


def test_an_action_is_a_type() -> None:
    action = ros2.load("example_interfaces/action/Fibonacci")
    assert isinstance(action, Action)
    assert action is Library.action(_library(), "example_interfaces/Fibonacci")
    goal = action.Goal(order=3)
    asked = action.SendGoal.Request(goal=goal)
    back = action.SendGoal.Request.from_ros(b"".join(asked.to_ros()))
    assert back.goal.order == 3
    assert pickle.loads(pickle.dumps(asked)) == asked
    assert repr(action) == "<action example_interfaces/action/Fibonacci>"
    with pytest.raises(UnknownType, match=r"of the action nobody/action/Nothing"):
        ros2.load("nobody/action/Nothing")


def _library() -> Library:
    from yarpy.peers.ros2.message.library import default_library

    return default_library()


def test_names() -> None:
    assert plain_name("a/msg/B") == plain_name("a/B") == "a/B"
    assert plain_name("a/action/B_Goal") == "a/action/B_Goal"
    assert action_name("a/B") == action_name("a/action/B") == "a/action/B"
    assert part_of("a/action/B_C_GetResult") == ("a/action/B_C", "GetResult")
    assert part_of("a/action/B") is None and part_of("a/B_Goal") is None
    with pytest.raises(DecodeError):
        plain_name("a/actions/B")


def test_a_message_of_the_package_is_not_of_the_action() -> None:
    texts = texts_of("a/action/Move", "Target target\n---\n---\n")
    assert texts["a/action/Move_Goal"] == "Target target\n"
    assert "a/action/Move_Goal goal\n" in texts["a/action/Move_SendGoal"]

    class Own:
        def find(self, name: str, kind: str) -> str | None:
            return {"a/Target msg": "int32 x\n", "a/Move action": "Target target\n---\n---\n"}.get(
                f"{name} {kind}"
            )

        def __str__(self) -> str:
            return "here"

    move = Library([Own(), Standard()]).action("a/Move")
    assert move.Goal.from_bottle([[4]]).target.x == 4
    with pytest.raises(DecodeError, match="goal, result and feedback"):
        texts_of("a/action/Move", "int32 x\n---\n")
