"""Types as nodes describe them."""

from typing import Any

import pytest

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.description import SERVICE, type_of
from yarpy.peers.ros2.message.hash import described, full_name
from yarpy.peers.ros2.message.library import Library, Service2, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard

LIBRARY = Library([Rosbags("jazzy"), Standard()])
Answer: Any = LIBRARY.service(SERVICE).Response
ODD = (
    "string<=8 a\nstring<=3[<=2] b\nfloat64[9] c\nstd_msgs/Empty d\nbyte[] e\nint8[<=4] f\nbool g\n"
    "wstring h\nwstring<=8[] i\n"
)


def description_of(kind: Any) -> Any:
    """What a node would say of a type."""
    if isinstance(kind, Service2):
        name = full_name(kind.name, "srv")
        halves = {"Request": kind.definition.request, "Response": kind.definition.response}
        rows = [described(f"{name}_{key}", half.parsed.fields) for key, half in halves.items()]
        used = [each for half in halves.values() for each in half.all_used()]
        whole = {"type_name": name, "fields": []}
    else:
        whole = described(full_name(kind._type), kind._definition.parsed.fields)
        rows, used = [], [*kind._definition.all_used()]
    rows += [described(full_name(each.name), each.parsed.fields) for each in used]
    made = {"type_description": whole, "referenced_type_descriptions": rows}
    answer = Answer.from_bottle({"successful": True, "type_description": made})
    return Answer.from_ros(b"".join(answer.to_ros())).type_description


def test_every_kind_of_field() -> None:
    odd = Library([Texts({"p/Odd": ODD}, "here"), Standard()]).message("p/Odd")
    found: Any = type_of(description_of(odd), "p/msg/Odd", "msg", hash_of(odd))
    assert found._md5sum == odd._md5sum
    assert found(a="x").a == "x"


@pytest.mark.parametrize(
    "name",
    ["sensor_msgs/PointCloud2", "std_srvs/Trigger", "example_interfaces/AddTwoInts", SERVICE],
)
def test_types_of_ros(name: str) -> None:
    kind = LIBRARY.load(name)
    what = "srv" if isinstance(kind, Service2) else "msg"
    assert hash_of(type_of(description_of(kind), name, what, hash_of(kind))) == hash_of(kind)


def test_what_is_wrong() -> None:
    string = LIBRARY.message("std_msgs/String")
    with pytest.raises(DecodeError, match=r"described as RIHS01_df66.* but named as RIHS01_0"):
        type_of(description_of(string), "std_msgs/String", "msg", "RIHS01_" + "0" * 64)
    with pytest.raises(DecodeError, match="of another type"):
        type_of(description_of(string), "p/Other", "msg", hash_of(string))
    with pytest.raises(DecodeError, match="no request"):
        type_of(description_of(string), "std_msgs/String", "srv", hash_of(string))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        *(("type_name", "a b"), ("type_name", "p/msg/A\nint8 x"), ("name", "a b"), ("name", "")),
        *(("type_id", 0), ("type_id", 255), ("type_id", 19), ("nested", "x")),
    ],
)
def test_nonsense_is_refused(path: str, value: Any) -> None:
    said = description_of(LIBRARY.message("std_msgs/String"))
    field = said.type_description.fields[0]
    if path == "type_name":
        said.type_description.type_name = value
    elif path == "name":
        field.name = value
    elif path == "type_id":
        field.type.type_id = value
    else:
        field.type.type_id, field.type.nested_type_name = 1, value
    with pytest.raises(DecodeError):
        type_of(said, "std_msgs/String", "msg", "RIHS01_" + "0" * 64)


def test_a_type_in_itself_is_refused() -> None:
    said = description_of(LIBRARY.message("std_msgs/String"))
    field = said.type_description.fields[0]
    field.type.type_id, field.type.nested_type_name = 145, "std_msgs/msg/String"
    with pytest.raises(DecodeError, match="contain themselves"):
        type_of(said, "std_msgs/String", "msg", "RIHS01_" + "0" * 64)
