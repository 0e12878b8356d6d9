"""Checksums and full texts: those of ROS; cycles, bombs and holes: clear errors."""

import pytest
from support import ros

from yarpy.errors import DecodeError, UnknownType
from yarpy.limit import ROS_DEPTH
from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.definition import split_full_text
from yarpy.peers.ros.message.source import Standard, Texts


def catalogue(texts: dict[str, str]) -> Catalogue:
    return Catalogue([Texts(texts, "a test"), Standard()])


@pytest.mark.parametrize(
    ("name", "md5sum"),
    [
        ("std_msgs/Empty", "d41d8cd98f00b204e9800998ecf8427e"),
        ("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1"),
        ("std_msgs/Header", "2176decaecbce78abc3b96ef049fabed"),
        ("sensor_msgs/PointField", "268eacb2962780ceac86cbd17e328150"),
        ("turtlesim/Pose", "863b248d5016ca62ea2e895ae5265cf9"),
        ("geometry_msgs/Twist", "9f195f881246fdfa2798d1d3eebca84a"),
    ],
)
def test_known_checksums(name: str, md5sum: str) -> None:
    texts = {
        "turtlesim/Pose": "float32 x\nfloat32 y\nfloat32 theta\n\n"
        "float32 linear_velocity\nfloat32 angular_velocity",
        "geometry_msgs/Twist": "Vector3  linear # m/s\nVector3  angular\n",
        "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    }
    assert catalogue(texts).message(name).md5sum == md5sum


def test_services_have_one_checksum() -> None:
    add = Catalogue([]).service_of(
        "rospy_tutorials/AddTwoInts", "int64 a\nint64 b\n---\nint64 sum\n"
    )
    assert add.md5sum == "6a2e34150c00229791cc89ff309fff21"
    # What C++ YARP sends instead: recorded, and refused by rospy.
    assert add.request.md5sum == "36d09b846be0b371c5f190354dd3153e"
    assert add.full_text == "int64 a\nint64 b\n---\nint64 sum\n"


@pytest.mark.peer("ros")
def test_every_installed_type_is_that_of_ros() -> None:
    """Checksums (what `rosmsg md5` prints), full texts and fields of all packages of Debian."""
    found = Catalogue()
    installed = ros.installed()
    assert installed
    for key, (md5sum, halves) in installed.items():
        kind, name = key.split()
        if kind == "msg":
            definition = found.message(name)
            ours = [definition]
        else:
            service = found.service(name)
            definition, ours = service, [service.request, service.response]
        assert (name, definition.md5sum) == (name, md5sum)
        for half, (half_md5sum, text, slots) in zip(ours, halves, strict=True):
            assert (half.name, half.md5sum) == (half.name, half_md5sum)
            assert half.full_text == text
            assert [item.name for item in half.struct.fields] == slots


@pytest.mark.peer("ros")
def test_odd_declarations_sum_up_as_in_ros() -> None:
    text = (
        "byte a\nchar[4] b\ntime[] c\nduration[2] d\nstd_msgs/Header[] headers\n"
        "string S=  with spaces # and a hash  \nint32   N =  7  # seven\n"
        "float32 F=1.50\nbool T=True"
    )
    program = """
import genmsg
context = genmsg.MsgContext.create_default()
spec = genmsg.msg_loader.load_msg_from_string(context, given, "odd/Odd")
genmsg.msg_loader.load_depends(context, spec, {"std_msgs": ["/usr/share/std_msgs/msg"]})
answer = genmsg.compute_md5(context, spec)
"""
    assert catalogue({"odd/Odd": text}).message("odd/Odd").md5sum == ros.ask(program, text)


def test_full_texts_round_trip() -> None:
    found = Catalogue([Standard()])
    cloud = found.message("sensor_msgs/PointCloud2")
    assert [used.name for used in cloud.all_used()] == ["std_msgs/Header", "sensor_msgs/PointField"]
    texts = split_full_text(cloud.name, cloud.full_text)
    assert [*texts] == ["sensor_msgs/PointCloud2", "std_msgs/Header", "sensor_msgs/PointField"]
    again = Catalogue([]).message_of(cloud.name, cloud.full_text)
    assert again.md5sum == cloud.md5sum
    assert again.full_text == cloud.full_text


def test_cycles_are_named() -> None:
    texts = {"p/A": "B b", "p/B": "int32 x\nC[] c", "p/C": "p/A a", "p/Own": "Own[] own"}
    with pytest.raises(DecodeError, match="contain themselves: p/A > p/B > p/C > p/A"):
        catalogue(texts).message("p/A")
    with pytest.raises(DecodeError, match="p/Own > p/Own"):
        catalogue(texts).message("p/Own")


def test_missing_types_are_named_with_the_message_that_needs_them() -> None:
    with pytest.raises(UnknownType) as caught:
        catalogue({"p/A": "nowhere/Thing t"}).message("p/A")
    assert "nowhere/Thing, which p/A contains" in str(caught.value)
    assert "nowhere/msg/Thing.msg" in str(caught.value)
    assert "a test" in str(caught.value)


def test_bombs_do_not_go_off() -> None:
    """Definitions come from strangers: small texts must not stand for huge values."""
    doubling = {f"p/A{n}": f"A{n + 1} x\nA{n + 1} y" for n in range(40)}
    for last in ("int8 x", ""):
        with pytest.raises(DecodeError, match="too large"):
            catalogue({**doubling, "p/A40": last}).message("p/A0")
    for text in ("float64[1000000000] x", "string[9999999999] x", "std_msgs/Header[30000000] x"):
        with pytest.raises(DecodeError, match="too large"):
            catalogue({"p/A": text}).message("p/A")
    with pytest.raises(DecodeError, match="takes no bytes"):
        catalogue({"p/A": "std_msgs/Empty[] x"}).message("p/A")
    chain = {f"p/A{n}": f"A{n + 1} x" for n in range(5000)}
    with pytest.raises(DecodeError, match=f"nested more than {ROS_DEPTH} deep"):
        catalogue(chain).message("p/A0")


def test_lists_of_doubling_messages_take_no_time() -> None:
    doubling = {f"p/A{n}": f"A{n + 1}[] x\nA{n + 1}[] y" for n in range(40)}
    found = catalogue({**doubling, "p/A40": "int8 x"}).message("p/A0")
    assert len([*found.all_used()]) == 40
    assert found.full_text.count("MSG: ") == 40


def test_there_is_a_limit_of_declarations() -> None:
    """Each becomes code, which takes far more memory than its text."""
    many = "".join(f"int8 a{n}\n" for n in range(1001))
    with pytest.raises(DecodeError, match="p/A: more than 1000 fields and constants"):
        catalogue({"p/A": many}).message("p/A")
    texts = {f"p/A{n}": "".join(f"string a{m}\n" for m in range(900)) for n in range(4)}
    texts["p/All"] = "".join(f"A{n} a{n}\n" for n in range(4))
    with pytest.raises(DecodeError, match="p/All: more than 3000 fields and constants, with those"):
        catalogue(texts).message("p/All")
