"""Where texts come from: folders of every shape, ROS_PACKAGE_PATH, rosbags, yarpy's own."""

import os
from pathlib import Path

import pytest
from support import ros

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Folder, Packages, Rosbags, Standard, read_text
from yarpy.peers.ros.message.standard import MESSAGES


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("file", "folder"),
    [
        ("turtlesim/msg/Pose.msg", "."),
        ("turtlesim/Pose.msg", "."),
        ("turtlesim/msg/Pose.msg", "turtlesim"),
        ("turtlesim/Pose.msg", "turtlesim"),
        ("turtlesim/msg/Pose.msg", "turtlesim/msg"),
    ],
)
def test_folders(tmp_path: Path, file: str, folder: str) -> None:
    write(tmp_path / file, "float32 x")
    found = Folder(tmp_path / folder)
    assert found.find("turtlesim/Pose", "msg") == "float32 x"
    assert found.find("turtlesim/Pose", "srv") is None
    assert found.find("other/Pose", "msg") is None
    assert str(found) == str(tmp_path / folder)


def test_packages_lie_anywhere_below_a_root(tmp_path: Path) -> None:
    write(tmp_path / "src/repo/one/package.xml", "<package><name> one_msgs </name></package>")
    write(tmp_path / "src/repo/one/msg/A.msg", "int8 a")
    write(tmp_path / "src/repo/one/srv/Do.srv", "---")
    write(tmp_path / "src/.hidden/two/package.xml", "<name>two</name>")
    write(tmp_path / "src/.hidden/two/msg/A.msg", "int8 a")
    write(tmp_path / "direct/msg/B.msg", "int8 b")
    write(tmp_path / "share/installed/msg/C.msg", "int8 c")
    environment = {
        "ROS_PACKAGE_PATH": f"{tmp_path / 'nowhere'}{os.pathsep}{tmp_path}",
        "CMAKE_PREFIX_PATH": str(tmp_path),
    }
    found = Packages.of(environment)
    assert found.find("one_msgs/A", "msg") == "int8 a"
    assert found.find("one_msgs/Do", "srv") == "---"
    assert found.find("direct/B", "msg") == "int8 b"
    assert found.find("installed/C", "msg") == "int8 c"
    assert found.find("two/A", "msg") is None
    assert "ROS_PACKAGE_PATH" in str(found)


def test_what_rosbags_brings_has_the_checksums_of_ros() -> None:
    pytest.importorskip("rosbags")
    found = Catalogue([Rosbags()])
    assert found.message("geometry_msgs/Twist").md5sum == "9f195f881246fdfa2798d1d3eebca84a"
    assert found.message("sensor_msgs/JointState").md5sum == "3066dcd76a6cfaef579bd0f34173e9fd"
    assert Rosbags().find("builtin_interfaces/Time", "msg") is None
    assert Rosbags().find("std_srvs/Empty", "srv") is None


@pytest.mark.peer("ros")
def test_installed_types_that_rosbags_knows_are_the_same() -> None:
    pytest.importorskip("rosbags")
    source, compared = Rosbags(), 0
    found = Catalogue([source])
    for key, (md5sum, _) in ros.installed().items():
        kind, name = key.split()
        if source.find(name, kind) is not None:
            assert (name, found.message(name).md5sum) == (name, md5sum)
            compared += 1
    assert compared


def test_without_rosbags_the_source_is_empty_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "rosbags.typesys", None)
    found = Rosbags()
    assert found.find("std_msgs/String", "msg") is None
    assert "pip install 'yarpy[ros]'" in str(found)


def test_what_yarpy_brings_is_what_ros_has() -> None:
    ours, theirs = Catalogue([Standard()]), Catalogue([Rosbags()])
    pytest.importorskip("rosbags")
    for name in MESSAGES:
        if name.startswith(("std_msgs", "sensor_msgs")):
            assert ours.message(name).md5sum == theirs.message(name).md5sum
    audio = ours.message("audio_common_msgs/AudioData")
    assert audio.md5sum == "f43a8e1b362b75baa741461b46adc7e0"


def test_files_have_a_limit_and_the_line_ends_of_ros(tmp_path: Path) -> None:
    path = tmp_path / "A.msg"
    path.write_bytes(b"int8 a\r\nint8 b\xff\n")
    assert read_text(path) == "int8 a\nint8 b\udcff\n"
    path.write_bytes(b"#" * ((1 << 20) + 1))
    with pytest.raises(DecodeError, match="more than"):
        read_text(path)
