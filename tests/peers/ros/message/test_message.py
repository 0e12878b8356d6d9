"""What the classes of all types have in common."""

import copy
import pickle

import numpy as np
import pytest

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.message import Duration, Message, Time


def test_times_as_seconds() -> None:
    assert Time.from_sec(12.5) == Time(12, 500_000_000)
    assert Time(12, 500_000_000).to_sec() == 12.5
    assert Duration.from_sec(-0.25) == Duration(-1, 750_000_000)
    assert Duration(-1, 750_000_000).to_sec() == -0.25
    assert Time.from_sec(0.9999999999) == Time(1, 0)


def test_seconds_are_a_time_wherever_one_is_wanted(library: Library) -> None:
    every = library.message("test/Every")
    given = {"stamp": 12.5, "span": -0.25, "stamps": [3, 1.5], "spans": [2.5, 0]}
    wanted = every(
        stamp=Time(12, 500_000_000),
        span=Duration(-1, 750_000_000),
        stamps=[Time(3, 0), Time(1, 500_000_000)],
        spans=[Duration(2, 500_000_000), Duration()],
    )
    made = every(**given)
    assert every.from_ros(b"".join(made.to_ros())) == wanted
    assert every.from_wire(b"".join(made.to_wire())) == wanted
    assert made.to_bottle() == wanted.to_bottle()
    assert every.from_bottle(given) == wanted
    with pytest.raises(DecodeError, match=r"test/Every\.stamp: -1 does not fit in time"):
        every.from_bottle({"stamp": -1})


def test_equality(library: Library) -> None:
    joints = library.message("sensor_msgs/JointState")
    one, two = joints(position=np.array([1.0, 2.0])), joints(position=[1.0, 2.0])
    assert one == two
    two.position[1] = 3.0
    assert one != two
    assert joints(name=["a"]) == joints(name=("a",))
    assert joints(name=["a"]) != joints(name=["a", "b"])
    assert joints() != library.message("std_msgs/String")()
    assert joints() != 3
    with pytest.raises(TypeError):
        hash(one)


def test_repr_shows_fields_and_sums_up_large_arrays(library: Library) -> None:
    image = library.message("sensor_msgs/Image")(height=2, data=np.zeros(1000, "u1"))
    assert "height=2" in repr(image)
    assert "data=<1000 uint8>" in repr(image)
    joints = library.message("sensor_msgs/JointState")(name=["a"], position=np.array([1.5]))
    assert repr(joints) == (
        "JointState(header=Header(seq=0, stamp=Time(secs=0, nsecs=0), frame_id=''), name=['a'], "
        "position=[1.5], velocity=[], effort=[])"
    )


def test_dicts(library: Library) -> None:
    every = library.message("test/Every")(text="t", pair=[library.message("test/Inner")()] * 2)
    found = every.to_dict()
    assert [*found][:2] == ["flag", "i8"]
    assert found["pair"] == [{"x": 0.0, "name": ""}] * 2
    assert found["stamp"] == {"secs": 0, "nsecs": 0}
    assert library.message("test/Words")(from_="a").to_dict()["from"] == "a"


def test_copies_and_pickles_need_no_definition(library: Library) -> None:
    pose = library.message("turtlesim/Pose")(x=1.0, theta=0.5)
    other = copy.deepcopy(pose)
    assert other == pose
    other.x = 2.0
    assert other != pose
    again = pickle.loads(pickle.dumps(pose))
    assert again == pose
    assert type(again)._type == "turtlesim/Pose"


def test_only_classes_of_types_have_values() -> None:
    with pytest.raises(TypeError, match=r"yarpy\.idl\.load"):
        Message()
