"""Keys, as they were published for the RMW."""

import pytest

from yarpy.errors import AddressError
from yarpy.peers.ros2.key import Key, domain

STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
GOLDEN = {
    f"0/chatter/std_msgs::msg::dds_::String_/{STRING}": (
        Key(0, "/chatter", "std_msgs::msg::dds_::String_", STRING)
    ),
    f"0/robot1/chatter/std_msgs::msg::dds_::String_/{STRING}": (
        Key(0, "/robot1/chatter", "std_msgs::msg::dds_::String_", STRING)
    ),
    f"2/add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/{ADD}": (
        Key(2, "/add_two_ints", "example_interfaces::srv::dds_::AddTwoInts_", ADD)
    ),
    "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported": (  # Humble
        Key(0, "/chatter", "std_msgs::msg::dds_::String_", "TypeHashNotSupported")
    ),
}


@pytest.mark.parametrize("text", GOLDEN)
def test_golden_keys(text: str) -> None:
    assert str(GOLDEN[text]) == text


def test_domains() -> None:
    assert domain(None, {}) == 0
    assert domain(None, {"ROS_DOMAIN_ID": "7"}) == 7
    assert domain("9", {"ROS_DOMAIN_ID": "7"}) == 9
    for text in ("x", "-1", "233", "1000", "٣"):
        with pytest.raises(AddressError, match="ROS_DOMAIN_ID"):
            domain(text, {})
