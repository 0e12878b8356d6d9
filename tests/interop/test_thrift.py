"""Thrift beside C++ YARP 3.5: a service of `yarpidl_thrift`, called and calling."""

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from support.cpp import CppYarp
from support.cpp_thrift import INTERFACE, thrift_peer
from support.peer import brings
from support.process import Process
from support.wait import HANG

import yarpy
from yarpy.kits.thrift.library import loads


@pytest.fixture(scope="module")
@brings("g++")
def program(cpp: CppYarp) -> Path:
    return thrift_peer(cpp)


@pytest.fixture(scope="module")
def capt() -> ModuleType:
    return loads(INTERFACE, "capt")


@pytest.fixture
def cpp_client(program: Path, our_names: CppYarp, capt: ModuleType) -> Iterator[Any]:
    """A client of a C++ server."""
    arguments = [program, "server", "/cpp/thrift"]
    with Process(arguments, env=our_names.environment, cwd=our_names.home) as server:
        server.wait_line("^ready")
        with capt.connect("/cpp/thrift", timeout=HANG) as client:
            yield client


@pytest.mark.timeout(500)
def test_cpp_gives_back_what_it_is_sent(cpp: CppYarp, cpp_client: Any, capt: ModuleType) -> None:
    point, color = capt.Point, capt.Color
    # Beside fractions 4.0.0 does not read lists of lists, which are spelled as 4.0.1 will.
    lists = [[1, 2], []] if cpp.version < (4, 0) else []
    nest = capt.Nest(point(1, 2), [point(3, 4)], {"a": point(7, 8)}, lists, {"v": [1.5]})
    for name, value in {
        "r_i8": -7,
        "r_i16": -300,
        "r_i32": 123456,
        "r_i64": 5_000_000_000,
        "r_double": 3.25,
        "r_float32": 1.5,
        "r_ui8": 200,
        "r_vocab": "get",
        "r_string": "two words",
        "r_bool": False,
        "r_enum": color.DARK_BLUE,
        "r_lstring": ["a", "b c"],
        "r_lenum": [color.RED, color.GREEN],
        "r_mint": {"a": 1, "b": 2},
        "r_mstruct": {"k": point(1, 2)},
        "r_lstruct": [point(1, 2), point(3, 4)],
        "r_struct": point(4, 5),
        "r_one": capt.One(1.5),
        "r_anno": capt.Anno("set", 250, 65000, 1 << 31, 1 << 40, 1.25, 2.5, 9),
        "r_prims": capt.Prims(True, 1, 2, 3, 4, 5.5, "s", b"x\0", color.GREEN),
        "r_nest": nest,
    }.items():
        found = getattr(cpp_client, name)(value)
        if name == "r_nest":
            assert found.to_text() == nest.to_text()
        else:
            assert found == value, name
    for name, numbers in {"r_lint": [1, 2, 3], "r_ldouble": [1.5, 2.5]}.items():
        assert getattr(cpp_client, name)(numbers).tolist() == numbers
        assert getattr(cpp_client, name)([]).tolist() == []
    assert [each.tolist() for each in cpp_client.r_llist([[1, 2], [], [3]])] == [[1, 2], [], [3]]


@pytest.mark.timeout(500)
def test_cpp_is_called(cpp: CppYarp, cpp_client: Any) -> None:
    assert cpp_client.add(2, 40) == 42
    assert cpp_client.nothing() is None and cpp_client.noargs() == 77
    assert cpp_client.fire(5) is None
    assert (cpp_client.check_defaults(), cpp_client.check_defaults(7)) == (True, False)
    assert cpp_client.tail_defaults(1, n=9) == "1 2 9 def word"
    assert cpp_client.get_long_method_name(10, "abc") == 13
    newer = cpp.version >= (3, 12)  # it could not be asked before
    assert cpp_client.remote_version() == ((0, *cpp.version, 0) if newer else None)
    assert cpp_client.add(1, 1) == 2  # what was not known has not hurt


@pytest.mark.timeout(500)
def test_cpp_calls(program: Path, our_names: CppYarp, capt: ModuleType) -> None:
    heard: list[Any] = []

    class Server(capt.Capt):  # type: ignore[misc, name-defined]
        def add(self, a: int, b: int) -> int:
            return a + b

        def no_result(self, text: str) -> None:
            heard.append(text)

        def nothing(self) -> None:
            heard.append("nothing")

        def noargs(self) -> int:
            return 77

        def fire(self, x: int) -> None:
            heard.append(x)

        def check_defaults(self, x: int) -> bool:
            return x == 42

        def tail_defaults(self, first: int, c: Any, n: int, s: str) -> str:
            return f"{first} {int(c)} {n} {s}"

        def get_long_method_name(self, first_arg: int, second_arg: str) -> int:
            return first_arg + len(second_arg)

        def const_method(self) -> bool:
            return True

    for name in capt.Capt._methods:
        if name.startswith("r_"):
            setattr(Server, name, lambda self, v: v)
    with yarpy.RpcServer("/our/thrift", Server()):
        arguments = [program, "client", "/our/thrift"]
        with Process(arguments, env=our_names.environment, cwd=our_names.home) as client:
            client.wait_line("^done", timeout=HANG)
            said = [line for line in client.stdout.splitlines() if not line.startswith("[")]
    assert said == [
        "add 42",
        "numbers -7 -300 5000000000 3.25 1.5 200",
        "words two words 10 7 2",
        "lists 3 b c 2.5 2",
        "nested 3",
        "map 2",
        "struct 4 5",
        "structs 3 4",
        "mstruct 1 2",
        "noargs 77",
        "defaults 10 1 2 5 def word",
        "long 13 1",
        "done",
    ]
    assert heard == ["text", "nothing", 5]
