"""The suite for monitors, on all that ship."""

from __future__ import annotations

from typing import Any

import pytest

from yarpy import registry
from yarpy.data.value import Vocab
from yarpy.monitors.base import DROP, Place
from yarpy.testing import MonitorConformance
from yarpy.testing.conformance_monitor import METHODS

# Those that come with scripts or ports of their own are tested where they live.
OTHERS = {"portmonitor", "rpc_monitor", "stats_monitor"}
TESTS = [name for name in vars(MonitorConformance) if name.startswith("test_")]


@pytest.mark.parametrize("test", TESTS)
@pytest.mark.parametrize("name", [n for n in registry.monitors.names() if n not in OTHERS])
def test_shipped(name: str, test: str) -> None:
    from monitors.test_shipped import CASES

    case = next((one for one in CASES if one[0].partition("+")[0] == name), None)
    text, ends, value, _ = case or (name, "recv", ["hello"], None)

    class Suite(MonitorConformance):
        monitor = staticmethod(registry.monitors.load(name))
        tokens = tuple(text.split("+")[1:])
        sending = ends != "recv"
        values = (value,)

    getattr(Suite(), test)()


class Greedy:
    """Lets nothing pass."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Any) -> object:
        return DROP


class Idle:
    """Does nothing at all."""

    def __init__(self, place: Place) -> None:
        pass


@pytest.mark.parametrize(
    ("kind", "test"), [(Greedy, "test_lets_messages_pass"), (Idle, "test_has_something_to_do")]
)
def test_a_monitor_that_is_wrong_is_caught(kind: Any, test: str) -> None:
    class Suite(MonitorConformance):
        monitor = kind
        values = ([Vocab("hi")],)

    with pytest.raises(AssertionError):
        getattr(Suite(), test)()


def test_methods_are_those_of_the_contract() -> None:
    import yarpy.monitors.base as base

    assert all(f"    {name}(" in (base.__doc__ or "") for name in METHODS)
