"""The language of `.msg` and `.srv` files of ROS 2, and what is none of it."""

import pytest

from yarpy.errors import DecodeError
from yarpy.peers.ros2.message.parse import parse_message, parse_service

TEXT = """\
# Where a robot is

std_msgs/Header header
int32 X=-3
string GREETING = "hi # there"  # of those who meet it
string<=8 name "nobody"   # short
# how sure it is
float64[9] covariance
uint8[<=4] few
bool ok true
int32[] numbers [1, -2]
Other other
geometry_msgs/msg/Pose pose
"""


def test_every_kind_of_declaration() -> None:
    found = parse_message(TEXT, "test_msgs/Place")
    assert found.doc == "Where a robot is"
    rows = [(item.name, item.base, item.is_list, item.length, item.most) for item in found.fields]
    assert rows == [
        ("header", "std_msgs/Header", False, None, None),
        ("name", "string", False, None, None),
        ("covariance", "float64", True, 9, None),
        ("few", "uint8", True, None, 4),
        ("ok", "bool", False, None, None),
        ("numbers", "int32", True, None, None),
        ("other", "test_msgs/Other", False, None, None),
        ("pose", "geometry_msgs/Pose", False, None, None),
    ]
    by_name = {item.name: item for item in found.fields}
    assert by_name["name"].spelled == "string<=8"
    assert by_name["name"].doc == "short"
    assert by_name["covariance"].doc == "how sure it is"
    assert (by_name["name"].default, by_name["ok"].default) == ("nobody", True)
    assert by_name["numbers"].default == (1, -2)
    constants = [(item.name, item.value) for item in found.constants]
    assert constants == [("X", -3), ("GREETING", "hi # there")]


def test_byte_and_char_are_unsigned_here() -> None:
    found = parse_message("byte a\nchar b\nbyte HIGH=200\n", "p/T")
    assert [item.base for item in found.fields] == ["uint8", "uint8"]
    assert [item.spelled for item in found.fields] == ["byte", "char"]
    assert found.constants[0].value == 200


def test_service() -> None:
    asked, answered = parse_service("int64 a\n---\n# of both\nint64 sum\n", "p/Add")
    assert (asked.name, [item.name for item in asked.fields]) == ("p/Add_Request", ["a"])
    assert (answered.name, [item.name for item in answered.fields]) == ("p/Add_Response", ["sum"])
    with pytest.raises(DecodeError, match=r"p/Add_Response, line 3"):
        parse_service("int64 a\n---\nint64\n", "p/Add")


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("int32", "a type and a name are expected"),
        ("int32<=3 a", "only strings"),
        ("int32[0] a", "no elements"),
        ("int32 a b", "no value of a int32"),
        ("int32 a-b", "letters, digits"),
        ("uint8 a 256", "no value of a uint8"),
        ("int32[2] a [1]", "of that length"),
        ("int32[] a [1, 'x']", "no value"),
        ("int32[] a 1", "of that length"),
        ("Other a 1", "have a default"),
        ("int32[] A=1", "a constant is"),
        ("p/srv/T a", "is no message"),
        ("bool a 2", "no value of a bool"),
        ("float32 a " + "1" * 401, "no value"),
        ("int32 a\nint32 a", "two declarations"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(line: str, says: str) -> None:
    with pytest.raises(DecodeError, match=says) as caught:
        parse_message(f"# first\n{line}\n", "p/T")
    assert "p/T, line" in str(caught.value)


def test_limits() -> None:
    with pytest.raises(DecodeError, match="1048576 characters"):
        parse_message("#" * (1 << 21), "p/T")
    with pytest.raises(DecodeError, match="1000 fields"):
        parse_message("".join(f"int32 a{at}\n" for at in range(1001)), "p/T")


@pytest.mark.parametrize("text", ["[{[]:1}]", "[{[],{}}]", "{{}}"])
def test_defaults_that_are_none(text: str) -> None:
    with pytest.raises(DecodeError, match="is no list of bool"):
        parse_message(f"bool[] a {text}", "p/T")


def test_comments_that_are_not_utf_8() -> None:
    text = "int32 a # \xb0C".encode("latin-1").decode("utf-8", "surrogateescape")
    assert parse_message(text, "p/T").fields[0].doc == "\xb0C"
