"""`yarpy idl`: types of ROS and Thrift shown, and Python written for them."""

import subprocess
import sys
from pathlib import Path

import pytest

from yarpy.idl.thrift import load

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
    from yarpy.idl.rosmsg.library import Library
    from yarpy.idl.rosmsg.source import Folder
    from yarpy.ros.type_server import TypeServer

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
    assert "no definition of the message nowhere/Thing was found. Asked: " in said.err
    said = here("idl", "rosmsg", "Pose")
    assert said.code == 1 and "named package/Type" in said.err
    (folder / "turtlesim/msg/Wrong.msg").write_text("float32\n")
    said = here("idl", "rosmsg", "--folder", str(folder), "turtlesim/Wrong")
    assert said.code == 1 and "turtlesim/Wrong, line 1: a type and a name" in said.err
    assert here("idl", "rosmsg", "missing.msg").code == 1
    assert here("idl", "rosmsg").code == 1


def test_a_file_for_what_a_port_sends(cli, names):
    import yarpy

    with (
        yarpy.Port("/motor/state:o", names=names) as port,
        cli.start("idl", "sniff", "/motor/state:o") as sniffing,
    ):
        assert port.wait_for_outputs(timeout=10)
        port.write(yarpy.Vector([10.0, 20.0, 30.0, 40.0]))
        sniffing.wait_line(r"int32 v_tag # .*266")
        sniffing.wait_line(r"float64\[\] v ")
        assert sniffing.wait() == 0


def test_types_or_a_port_are_named(here):
    said = here("idl", "rosmsg")
    assert said.code == 1
    assert "which types?" in said.err


def test_thrift_is_written(here, tmp_path, monkeypatch):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "shape.thrift").write_text("struct Point { 1: i32 x }")
    arm = tmp_path / "arm.thrift"
    arm.write_text(
        'include "shape.thrift"\nenum E { A }\nservice Arm { shape.Point get(), void stop() }'
    )
    arguments = ("idl", "thrift", str(arm), "--folder", str(tmp_path / "lib"))
    said = here(*arguments, "--check")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines()[1] == f"{arm}: 1 enum, 2 methods in Arm"
    assert said.out.splitlines()[0].endswith("shape.thrift: 1 struct")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.thrift", "lib"]
    out = tmp_path / "out"
    said = here(*arguments, "--out", str(out))
    assert said.out == f"{out}/shape.py, {out}/shape.pyi\n{out}/arm.py, {out}/arm.pyi\n"
    monkeypatch.syspath_prepend(str(out))
    done = subprocess.run(
        [sys.executable, "-c", "import arm, sys; print(arm.shape.Point(3), 'lark' in sys.modules)"],
        cwd=out, capture_output=True, text=True, check=True, timeout=50,
    )  # fmt: skip
    assert done.stdout == "Point(x=3) False\n"


def test_all_files_are_checked(here, tmp_path):
    (tmp_path / "a.thrift").write_text("struct A { 1: i32 x")
    (tmp_path / "b.thrift").write_text("struct B { 1: i32 x }")
    (tmp_path / "c.thrift").write_text("struct C { 1: Nothing x }")
    files = [str(tmp_path / f"{name}.thrift") for name in "abcd"]
    said = here("idl", "thrift", "--check", *files)
    assert said.code == 1
    assert said.out == f"{files[1]}: 1 struct\n"
    errors = said.err.splitlines()
    assert len(errors) == 3
    for error, file in zip(errors, (files[0], files[2], files[3]), strict=True):
        assert error.startswith("error: ") and file in error
    said = here("idl", "thrift", *files, "--out", str(tmp_path / "out"))
    assert (said.code, said.err.splitlines()) == (1, errors)
    assert not (tmp_path / "out").exists()


def test_no_module_that_is_written_hides_one_of_python(here, tmp_path):
    (tmp_path / "types.thrift").write_text("struct Point { 1: i32 x }")
    arm = tmp_path / "arm.thrift"
    arm.write_text('include "types.thrift"\nservice Arm { types.Point get() }')
    out = tmp_path / "out"
    said = here("idl", "thrift", str(arm), "--out", str(out))
    assert said.out == f"{out}/types_.py, {out}/types_.pyi\n{out}/arm.py, {out}/arm.pyi\n"
    done = subprocess.run(
        [sys.executable, "-c", "import arm; print(arm.types.Point(3))"],
        cwd=out, capture_output=True, text=True, check=True, timeout=50,
    )  # fmt: skip
    assert done.stdout == "Point(x=3)\n"
    assert load(arm).types.Point(3).x == 3


def test_wrong_thrift_files_are_named_with_the_line(here, tmp_path):
    good, bad = tmp_path / "good.thrift", tmp_path / "bad.thrift"
    good.write_text("struct A {}")
    bad.write_text("struct A {\n  1: i32 x = 'y'\n}")
    out = tmp_path / "out"
    said = here("idl", "thrift", str(good), str(bad), "--out", str(out))
    assert said.code == 1 and f"{bad}:2: expected a value for i32, found 'y'" in said.err
    assert not out.exists()
    said = here("idl", "thrift", str(tmp_path / "none.thrift"))
    assert said.code == 1 and "none.thrift" in said.err
    odd = tmp_path / "my-arm.thrift"
    odd.write_text("struct A {}")
    said = here("idl", "thrift", str(odd))
    assert said.code == 1 and "no module is called my-arm: rename it" in said.err
