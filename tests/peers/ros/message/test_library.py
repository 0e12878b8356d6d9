"""Types by name: one class each, whoever describes it."""

from pathlib import Path

import pytest

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros.message import library as module
from yarpy.peers.ros.message.library import Library, Service
from yarpy.peers.ros.message.source import Standard, Texts


def test_a_type_has_one_class(library: Library) -> None:
    header = library.message("std_msgs/Header")
    assert library.message("std_msgs/msg/Header") is header
    assert library.load("std_msgs/Header") is header
    assert type(library.message("sensor_msgs/Image")().header) is header


def test_types_of_peers_are_ours_if_they_are_the_same(library: Library) -> None:
    image = library.message("sensor_msgs/Image")
    commented = "# of a peer\n" + image._full_text
    assert library.message_of("sensor_msgs/Image", commented) is image
    other = library.message_of("sensor_msgs/Image", "Header header\nint32 other\n")
    assert other is not image
    assert type(other().header) is library.message("std_msgs/Header")
    assert library.message_of("sensor_msgs/Image", "Header header\nint32 other\n") is other
    assert library.message("sensor_msgs/Image") is image


def test_types_learnt_from_peers_first_stay_the_same() -> None:
    library = Library([Texts({"p/A": "int8 a"}, "a test")])
    met = library.message_of("p/A", "int8 a")
    assert library.message("p/A") is met


def test_types_of_peers_are_kept_up_to_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MET", 10)
    library = Library([])
    for n in range(50):
        library.message_of(f"p/A{n}", f"int8 a{n}")
    assert len(library._met) == len(library._texts) == 10


def test_types_of_peers_are_kept_up_to_a_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MET_SIZE", 20_000)
    library = Library([])
    for n in range(50):
        library.message_of(f"p/A{n}", f"int8 a{n}\n#" + 2000 * "x")
    assert [*library._met][-1][0] == "p/A49"
    assert len(library._met) == len(library._texts) == 3


def test_types_in_types_of_peers_count_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MET_SIZE", 200_000)
    library = Library([])
    for n in range(20):
        inner = "".join(f"int8 a{n}_{m}\n" for m in range(20))
        library.message_of(f"p/A{n}", f"p/B{n} b\n{'=' * 80}\nMSG: p/B{n}\n{inner}")
    assert len(library._met) < 5  # each of 80 kB, those that hold others as well
    assert len(library._texts) < 5


def test_types_of_peers_in_use_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MET_SIZE", 10_000)
    monkeypatch.setattr(module, "_ALIVE_SIZE", 50_000)
    library = Library([])
    in_use = []
    with pytest.raises(DecodeError, match="a type too many"):
        for n in range(50):
            in_use.append(library.message_of(f"p/A{n}", f"int8 a{n}"))
    assert 10 < len(in_use) < 20
    in_use.clear()
    for n in range(50, 100):  # nobody uses them, so there is room
        library.message_of(f"p/A{n}", f"int8 a{n}")


def test_services(library: Library) -> None:
    add = library.service_of("rospy_tutorials/AddTwoInts", "int64 a\nint64 b\n---\nint64 sum")
    assert isinstance(add, Service)
    assert (add.name, add.md5sum) == (
        "rospy_tutorials/AddTwoInts",
        "6a2e34150c00229791cc89ff309fff21",
    )
    assert add.Request._type == "rospy_tutorials/AddTwoIntsRequest"
    assert b"".join(add.Request(a=3, b=4).to_ros()).hex() == "03000000000000000400000000000000"
    assert repr(add) == "<service rospy_tutorials/AddTwoInts>"
    assert add.full_text.startswith("int64 a")


def test_what_stands_for_a_request(library: Library) -> None:
    add = library.service_of("p/Add", "int64 a\nint64 b\n---\nint64 sum\n")
    wanted = add.Request(5, 37)
    for arguments in ([wanted], [{"a": 5, "b": 37}], [[5, 37]], [(5, 37)], [5, 37]):
        assert add.request(*arguments) == wanted
    with pytest.raises(DecodeError, match="expected 2 elements"):
        add.request(5)
    with pytest.raises(TypeError, match="p/Add is asked with p/AddRequest, not p/AddResponse"):
        add.request(add.Response())
    total = library.service_of("p/Sum", "int64[] items\n---\nint64 sum\n")
    for arguments in ([[5, 37]], [[[5, 37]]], [{"items": [5, 37]}]):
        assert [*total.request(*arguments).items] == [5, 37]  # type: ignore[attr-defined]
    assert not len(total.request([]).items)  # type: ignore[attr-defined]
    with pytest.raises(DecodeError, match="expected 1 elements"):
        total.request(5, 37)
    nothing = library.service_of("p/Stop", "---\n")
    assert nothing.request() == nothing.request([]) == nothing.Request()


def test_names_and_files(tmp_path: Path) -> None:
    package = tmp_path / "robot_msgs"
    for folder in ("msg", "srv"):
        (package / folder).mkdir(parents=True)
    (package / "msg" / "Joint.msg").write_text("float64 angle")
    (package / "srv" / "Move.srv").write_text("Joint joint\n---")
    library = Library([Standard()])
    joint = library.load(package / "msg" / "Joint.msg")
    assert isinstance(joint, type)
    assert joint(angle=1.0).angle == 1.0
    move = library.load(str(package / "srv" / "Move.srv"))
    assert isinstance(move, Service)
    assert type(move.Request().joint) is joint
    with pytest.raises(FileNotFoundError):
        library.load(package / "msg" / "None.msg")
    with pytest.raises(UnknownType, match="the message or service robot_msgs/Nothing") as caught:
        library.load("robot_msgs/Nothing")
    assert "robot_msgs/msg/Nothing.msg or robot_msgs/srv/Nothing.srv into" in str(caught.value)
    (package / "msg" / "Wrong.msg").write_text("float64")
    with pytest.raises(DecodeError, match="robot_msgs/Wrong, line 1"):
        library.load(package / "msg" / "Wrong.msg")


def test_services_are_found_by_name_where_no_message_has_it(tmp_path: Path) -> None:
    from yarpy.peers.ros.message.source import Folder

    (tmp_path / "p" / "srv").mkdir(parents=True)
    (tmp_path / "p" / "srv" / "Do.srv").write_text("int8 a\n---\nint8 b")
    library = Library([Folder(tmp_path)])
    found = library.load("p/Do")
    assert isinstance(found, Service)
    assert library.service("p/Do") is found


def test_the_library_of_the_process_is_one() -> None:
    assert module.default_library() is module.default_library()
