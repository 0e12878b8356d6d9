"""`yarpy idl rosmsg`: types of ROS shown, and Python written for them."""

from pathlib import Path

import pytest

POSE = """\
# of a turtle
float32 x
float32 y
float32 theta

float32 linear_velocity
float32 angular_velocity
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    package = tmp_path / "packages" / "turtlesim"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    (package / "msg" / "Pose.msg").write_text(POSE)
    (package / "msg" / "Poses.msg").write_text("Pose[] poses\nuint8 MANY=3")
    (package / "srv" / "Spawn.srv").write_text("float32 x\n---\nstring name\n")
    return tmp_path / "packages"


def test_shown_as_rosmsg_does(here, folder):
    said = here("idl", "rosmsg", "--folder", str(folder), "turtlesim/Poses")
    assert (said.code, said.err) == (0, "")
    assert said.out.startswith("uint8 MANY=3\nturtlesim/Pose[] poses\n  float32 x\n")


def test_files_and_checksums(here, folder):
    raw = here("idl", "rosmsg", "--raw", str(folder / "turtlesim/msg/Pose.msg"))
    assert (raw.code, raw.out) == (0, POSE)
    md5 = here("idl", "rosmsg", "--md5", "--folder", str(folder), "turtlesim/Pose")
    assert md5.out == "863b248d5016ca62ea2e895ae5265cf9\n"
    two = here("idl", "rosmsg", "--md5", "std_msgs/String", "std_msgs/Header")
    assert two.out == (
        "992ce8a1687cec8c8bd883ec73ca41d1 std_msgs/String\n"
        "2176decaecbce78abc3b96ef049fabed std_msgs/Header\n"
    )


def test_several_are_told_apart(here, folder):
    said = here("idl", "rosmsg", "--folder", str(folder), "std_msgs/String", "turtlesim/Spawn")
    assert said.out == (
        "[std_msgs/String]:\nstring data\n[turtlesim/Spawn]:\nfloat32 x\n---\nstring name\n"
    )


def test_code(here, folder, tmp_path):
    said = here("idl", "rosmsg", "--python", "--folder", str(folder), "turtlesim/Poses")
    found = {}
    exec(said.out, found)
    assert found["Poses"](poses=[found["Pose"](x=1.0)]).poses[0].x == 1.0
    said = here("idl", "rosmsg", "--stubs", "--folder", str(folder), "turtlesim/Poses")
    assert "    poses: list[Pose]\n" in said.out


def test_contexts(here, folder, tmp_path):
    place = tmp_path / "data" / "contexts" / "lab" / "msgs"
    place.parent.mkdir(parents=True)
    folder.rename(place)
    assert here("idl", "rosmsg", "turtlesim/Poses").code == 1
    said = here("idl", "rosmsg", "--md5", "--context", "lab", "turtlesim/Pose")
    assert said.out == "863b248d5016ca62ea2e895ae5265cf9\n"


def test_types_of_the_network(cli, folder, names):
    from yarpy.peers.ros.message.library import Library
    from yarpy.peers.ros.message.source import Folder
    from yarpy.peers.ros.type_server import TypeServer

    wanted = ("turtlesim/Poses", "turtlesim/Spawn")
    server = TypeServer("/typ", Library([Folder(folder)]), names)
    try:
        said = cli.run("idl", "rosmsg", "--raw", *wanted)
    finally:
        server.close()
    assert (said.returncode, said.stderr) == (0, "")
    poses = (folder / "turtlesim/msg/Poses.msg").read_text()
    spawn = (folder / "turtlesim/srv/Spawn.srv").read_text()
    assert said.stdout == f"[{wanted[0]}]:\n{poses}\n[{wanted[1]}]:\n{spawn}"
    said = cli.run("idl", "rosmsg", *wanted)
    assert said.returncode == 1
    assert "the type server /typ (`yarpy idl rosmsg --name /typ@/yarpros` starts" in said.stderr


def test_what_is_not_there_or_wrong(here, folder):
    said = here("idl", "rosmsg", "nowhere/Thing")
    assert (said.code, said.out) == (1, "")
    assert "no definition of the message or service nowhere/Thing was found. Asked: " in said.err
    said = here("idl", "rosmsg", "Pose")
    assert said.code == 1 and "named package/Type" in said.err
    (folder / "turtlesim/msg/Wrong.msg").write_text("float32\n")
    said = here("idl", "rosmsg", "--folder", str(folder), "turtlesim/Wrong")
    assert said.code == 1 and "turtlesim/Wrong, line 1: a type and a name" in said.err
    assert here("idl", "rosmsg", "missing.msg").code == 1
    assert here("idl", "rosmsg").code == 1


def test_types_or_a_port_are_named(here):
    said = here("idl", "rosmsg")
    assert said.code == 1
    assert "which types?" in said.err
