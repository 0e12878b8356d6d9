"""The messages of an action."""

import pytest

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.shipped.action import messages_of, spelled


def test_an_action_is_seven_messages() -> None:
    found = messages_of("a/Bake", "int32 goal\n---\nint32 result\n---\nint32 part\n")
    assert found["a/BakeResult"] == "int32 result\n"
    assert found["a/BakeActionFeedback"].endswith("BakeFeedback feedback\n")
    assert sorted(found) == sorted(
        f"a/Bake{part}"
        for part in (
            *("Goal", "Result", "Feedback", "Action"),
            *("ActionGoal", "ActionResult", "ActionFeedback"),
        )
    )


@pytest.mark.parametrize("text", ["", "int32 x\n---\n", "---\n---\n---\n"])
def test_it_has_three_parts(text: str) -> None:
    with pytest.raises(DecodeError, match="goal, result and feedback"):
        messages_of("a/B", text)


def test_definitions_in_one_line() -> None:
    assert spelled("int32 a; ---; string b") == "int32 a\n---\nstring b\n"
