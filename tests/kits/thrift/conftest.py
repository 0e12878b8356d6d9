"""The interface that C++ YARP 3.9.1 was recorded with (tests/golden/thrift), and its server."""

from types import ModuleType
from typing import Any

import pytest
from support.thrift import GOLDEN

from yarpy.kits.thrift.library import load


@pytest.fixture(scope="session")
def capt() -> ModuleType:
    return load(GOLDEN / "capt.thrift")


@pytest.fixture
def server(capt: ModuleType) -> Any:
    """What the recorded C++ server did."""

    class Server(capt.Capt):  # type: ignore[misc, name-defined]
        fired: list[int] = []

        def add(self, a: int, b: int) -> int:
            return a + b

        def no_result(self, text: str) -> None:
            pass

        def nothing(self) -> None:
            pass

        def noargs(self) -> int:
            return 77

        def fire(self, x: int) -> None:
            self.fired = [*self.fired, x]

        def check_defaults(self, x: int) -> bool:
            return x == 42

        def tail_defaults(self, first: int, c: int, n: int, s: str) -> str:
            return f"{first} {int(c)} {n} {s}"

        def get_long_method_name(self, first_arg: int, second_arg: str) -> int:
            return first_arg + len(second_arg)

        def const_method(self) -> bool:
            return True

    for name in capt.Capt._methods:
        if name.startswith("r_"):
            setattr(Server, name, lambda self, v: v)
    return Server()
