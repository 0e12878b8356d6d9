"""Python code for types: it runs, and editors and type checkers understand it."""

import ast
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest
from support.type_check import type_check

from yarpy.peers.ros.message import library as library_module
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros.message.stub import python, stubs
from yarpy.peers.ros2.message.library import default_library as ros2_library


@pytest.fixture(autouse=True)
def own_library(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other tests may have met other texts of these types, and others may need what they added."""
    monkeypatch.setattr(library_module, "default_library", cache(Library))


def loaded(text: str) -> ModuleType:
    library_module.default_library.cache_clear()
    module = ModuleType("written")
    exec(text, module.__dict__)
    return module


def test_a_module_brings_what_its_types_contain(library: Library) -> None:
    image = library.message("sensor_msgs/Image")
    text = python([image, library.message("test/Every")])
    assert text.startswith(
        '"""Messages of ROS, written by `yarpy idl rosmsg --python`: sensor_msgs'
    )
    module = loaded(text)
    assert module.Image._md5sum == image._md5sum
    assert module.Image._full_text == image._full_text
    assert type(module.Image().header) is module.Header
    assert module.Every.LIMIT == 7
    assert module.Inner(x=1.0).x == 1.0


def test_services_and_their_halves(library: Library) -> None:
    add = library.service_of("p/Add", "int64 a # one\n---\nint64 sum\n")
    module = loaded(python([add]))
    assert module.Add.md5sum == add.md5sum
    assert module.Add.Request is module.AddRequest
    assert "class _Add(Service):" in stubs([add])


def test_seconds_are_accepted_for_a_time(library: Library) -> None:
    text = stubs([library.message("test/Every")])
    assert "    stamp: Time\n" in text
    assert "        stamp: Time | float = ...," in text
    ros2 = ros2_library().message("std_msgs/Header")
    assert "        stamp: builtin_interfaces_Time | float | None = ...," in stubs([ros2])


def test_comments_never_become_code() -> None:
    text = '# """; raise SystemExit\n# \\ \'\'\'\nint8 a # """ \\'
    odd = Library([Texts({"p/Odd": text}, "a test")]).message("p/Odd")
    assert loaded(python([odd])).Odd._md5sum == odd._md5sum
    ast.parse(stubs([odd]))


def test_types_of_one_name(library: Library) -> None:
    other = library.message_of(
        "p/Header",
        "std_msgs/Header header\nHeader2 more\n\n" + "=" * 80 + "\nMSG: p/Header2\nint8 x\n",
    )
    module = loaded(python([other]))
    assert module.p_Header is not module.std_msgs_Header
    assert "header: std_msgs_Header" in stubs([other])
    own = library.message_of("p/Time", "int8 x")
    assert "class p_Time(Message)" in stubs([own])


@pytest.mark.timeout(300)  # mypy may begin without its cache
def test_type_checkers_understand_the_stubs(library: Library, tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    types = [library.message("test/Every"), library.message("sensor_msgs/Image")]
    add = library.service_of("p/Add", "int64 a\n---\nint64 sum\n")
    (tmp_path / "msgs.py").write_text(python([*types, add]))
    (tmp_path / "msgs.pyi").write_text(stubs([*types, add]))
    (tmp_path / "use.py").write_text(
        "from msgs import Add, Every, Image, Inner\n"
        "every = Every(i32=3, f64s=[1, 2], inner=Inner(x=1.0), texts=['a'])\n"
        "number: float = every.inner.x + every.f64s.sum() + Every.LIMIT\n"
        "reveal_type(every.stamp.secs)\n"
        "reveal_type(Image().header.frame_id)\n"
        "reveal_type(Add.Response().sum)\n"
        "reveal_type(Image.from_ros(b''))\n"
        "Every(i32='three')\n"
    )
    done = type_check(tmp_path, "use.py", "msgs.pyi")
    lines = done.stdout.splitlines()
    assert [line.partition("Revealed type is ")[2] for line in lines if "Revealed" in line] == [
        '"int"',
        '"str"',
        '"int"',
        '"msgs.Image"',
    ], done.stdout
    errors = [line for line in lines if ": error: " in line]
    assert len(errors) == 1 and "use.py:8" in errors[0], done.stdout
