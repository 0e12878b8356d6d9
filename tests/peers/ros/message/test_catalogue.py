"""Types by name: the order of sources, files, full texts of peers, and who is blamed."""

from pathlib import Path

import pytest

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros.message.catalogue import Catalogue, standard_sources
from yarpy.peers.ros.message.definition import Definition, ServiceDefinition
from yarpy.peers.ros.message.source import Standard, Texts

ONE = Texts({"p/A": "int8 one", "p/B": "A a"}, "one")
TWO = Texts({"p/A": "int8 two", "p/C": "A a"}, "two")


def test_the_first_source_that_has_a_type_wins() -> None:
    found = Catalogue([ONE, TWO])
    assert found.text("p/A").text == "int8 one"
    assert str(found.text("p/C").source) == "two"
    assert found.message("p/C").used[0].parsed.text == "int8 one"


def test_definitions_are_kept_and_shared() -> None:
    found = Catalogue([ONE])
    assert found.message("p/B") is found.message("p/msg/B")
    assert found.message("p/B").used[0] is found.message("p/A")


def test_what_nobody_has_names_everybody() -> None:
    with pytest.raises(UnknownType) as caught:
        Catalogue([ONE, TWO]).service("p/Do")
    assert "no definition of the service p/Do was found. Asked: one; two." in str(caught.value)
    assert "p/srv/Do.srv" in str(caught.value)
    with pytest.raises(UnknownType, match="nobody"):
        Catalogue([]).message("p/A")
    with pytest.raises(DecodeError, match="is no type of ROS"):
        Catalogue([ONE]).message("../../p")


def test_where_ros_looks_comes_before_what_yarpy_brings() -> None:
    assert isinstance(standard_sources()[-1], Standard)
    assert Catalogue().message("std_msgs/String").md5sum == "992ce8a1687cec8c8bd883ec73ca41d1"


def test_full_texts_of_peers_are_not_kept() -> None:
    found = Catalogue([ONE])
    other = found.message_of("p/A", "float64 other")
    assert other.struct.fields[0].name == "other"
    assert found.message("p/A").struct.fields[0].name == "one"


def test_full_texts_may_lack_what_the_sources_have() -> None:
    found = Catalogue([ONE])
    assert found.message_of("q/X", "p/A a\n").used[0].parsed.text == "int8 one"
    service = found.service_of("q/Do", "p/A a\n---\nint8 b\n")
    assert service.request.used[0].name == "p/A"


def test_full_texts_that_are_none_are_refused() -> None:
    found = Catalogue([])
    with pytest.raises(DecodeError, match="names no type"):
        found.message_of("q/X", "int8 a\n\n" + "=" * 80 + "\nnothing")
    with pytest.raises(DecodeError, match="more than"):
        found.message_of("q/X", "#" * (1 << 23))
    with pytest.raises(UnknownType, match="the definition of q/X"):
        found.message_of("q/X", "Missing m")


def test_files_with_their_packages(tmp_path: Path) -> None:
    package = tmp_path / "robot_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    (package / "msg" / "Arm.msg").write_text("Joint[] joints\nbeside/Thing thing")
    (package / "msg" / "Joint.msg").write_text("float64 angle")
    (tmp_path / "beside").mkdir()
    (tmp_path / "beside" / "Thing.msg").write_text("int8 x")
    (package / "srv" / "Move.srv").write_text("Arm arm\n---\nbool ok")
    found = Catalogue([])
    arm = found.read(package / "msg" / "Arm.msg")
    assert isinstance(arm, Definition)
    assert [used.name for used in arm.all_used()] == ["robot_msgs/Joint", "beside/Thing"]
    move = found.read(package / "srv" / "Move.srv")
    assert isinstance(move, ServiceDefinition)
    assert (move.name, move.request.used[0].name) == ("robot_msgs/Move", "robot_msgs/Arm")
    with pytest.raises(OSError):
        found.read(package / "msg" / "None.msg")


def test_types_of_cpp_yarp_have_no_package() -> None:
    """Recorded: `type=AddTwoInts`, with the whole definition."""
    add = Catalogue([]).service_of("AddTwoInts", "int64 a\nint64 b\n---\nint64 sum\n")
    assert (add.name, add.request.name) == ("AddTwoInts", "AddTwoIntsRequest")
    text = f"Inner inner\n\n{'=' * 80}\nMSG: Inner\nint8 x\n"
    assert Catalogue([]).message_of("Outer", text).used[0].name == "Inner"
    with pytest.raises(DecodeError):
        Catalogue([]).message("AddTwoInts")
