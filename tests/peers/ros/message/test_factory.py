"""The class of a type: fields, defaults, constants, documentation."""

import inspect
from typing import Any

import numpy as np
import pytest

from yarpy.data.generated import Code
from yarpy.peers.ros.message.factory import annotation
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.message import Duration, Time
from yarpy.peers.ros.message.model import PRIMITIVES, ListOf


def test_defaults(library: Library) -> None:
    every = library.message("test/Every")()
    assert (every.flag, every.i32, every.f64, every.text) == (False, 0, 0.0, "")
    assert (every.stamp, every.span) == (Time(0, 0), Duration(0, 0))
    assert every.u32s.dtype == "u4" and every.u32s.tolist() == [0, 0, 0]
    assert every.u8s.dtype == "u1" and len(every.u8s) == 0
    assert every.flags.dtype == "bool"
    assert (every.texts, every.words, every.stamps) == ([], ["", ""], [])
    assert [type(item).__name__ for item in every.pair] == ["Inner", "Inner"]
    assert every.pair[0] is not every.pair[1]


def test_defaults_are_made_for_each_object(library: Library) -> None:
    joints = library.message("sensor_msgs/JointState")
    one, two = joints(), joints()
    one.name.append("a")
    one.header.seq = 3
    assert (two.name, two.header.seq) == ([], 0)


def test_values_by_place_and_by_name(library: Library) -> None:
    pose = library.message("turtlesim/Pose")
    assert pose(1.0, 2.0) == pose(y=2.0, x=1.0)
    with pytest.raises(TypeError, match="unexpected keyword"):
        pose(z=1.0)
    with pytest.raises(AttributeError):
        pose().z = 1.0


def test_constants_are_attributes_of_the_class(library: Library) -> None:
    every = library.message("test/Every")
    assert (every.LIMIT, every.WORD) == (7, "a word")
    assert library.message("sensor_msgs/PointField").FLOAT32 == 7
    with pytest.raises(AttributeError):
        every().LIMIT = 8


def test_names_that_python_needs_get_an_underscore(library: Library) -> None:
    words = library.message("test/Words")
    assert words._names == ("from_", "self_", "from__", "to_ros_")
    assert words.None_ == 3
    made = words(from_="a", from__=4)
    assert words.from_ros(b"".join(made.to_ros())) == made


def test_comments_are_documentation(library: Library) -> None:
    doc = library.message("test/Every").__doc__
    assert doc is not None
    assert doc.startswith("test/Every\n\nOne field of every kind.\n\n    bool flag\n")
    assert "    float64 f64  # in metres" in doc
    assert "    int32 LIMIT = 7  # at most" in doc


def test_what_connections_say_is_there_as_in_rospy(library: Library) -> None:
    string = library.message("std_msgs/String")
    assert string._type == "std_msgs/String"
    assert string._md5sum == "992ce8a1687cec8c8bd883ec73ca41d1"
    assert string._full_text == "string data\n"
    assert string.__slots__ == ("data",)


def test_annotations(library: Library) -> None:
    found = library.message("test/Every").__annotations__
    assert found["flag"] == "bool"
    assert found["u64"] == "int"
    assert found["f32"] == "float"
    assert found["f32s"] == "NDArray[np.float32]"
    assert found["flags"] == "NDArray[np.bool_]"
    assert found["texts"] == "list[str]"
    assert found["stamps"] == "list[Time]"
    assert found["pair"] == "list[Inner]"
    assert annotation(ListOf(PRIMITIVES["binary"])) == "list[bytes]"
    assert np.dtype(found["f32s"][11:18])


def test_nothing_is_compiled_before_it_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who describes a type need not ever send a value."""
    compiled: list[str] = []
    compile_it = Code.compiled

    def counted(code: Code, name: str, arguments: str) -> Any:
        compiled.append(name)
        return compile_it(code, name, arguments)

    monkeypatch.setattr(Code, "compiled", counted)
    text = f"int8 x\nB[] many\nB one\n{'=' * 80}\nMSG: p/B\nstring[] words\n"
    kind = Library([]).message_of("p/A", text)
    assert compiled == []
    assert kind.from_ros(bytes(1 + 4 + 4)).x == 0
    assert compiled == ["_read", "_read"]
    first = kind(5)
    kind(6)
    assert compiled[2:] == ["__init__", "__init__"]
    assert first.to_ros() == (b"\5" + bytes(8),)
    assert compiled[4:] == ["_write", "_write"]
    assert [*inspect.signature(kind).parameters] == ["x", "many", "one"]
    assert len(compiled) == 6

    class Derived(kind):  # type: ignore[misc, valid-type]
        pass

    assert Derived(x=7).to_ros() == (b"\7" + bytes(8),)
    assert len(compiled) == 6
