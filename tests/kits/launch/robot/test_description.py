"""Descriptions of robots as values."""

import pytest

from yarpy import Property
from yarpy.kits.launch.document.problem import NOWHERE
from yarpy.kits.launch.robot.description import (
    Action,
    Description,
    Device,
    Parameter,
    networks,
    options,
)


def action(phase: str = "startup", level: int = 0, kind: str = "attach", **more: object) -> Action:
    return Action(phase, level, kind, "a", Property(more), NOWHERE)


def test_parameters_are_lists_as_a_device_gets_them() -> None:
    group = Parameter("G", "", NOWHERE, (Parameter("n", '1 "b c"', NOWHERE),))
    found = options([Parameter("x", "5", NOWHERE), Parameter("l", "(a b)", NOWHERE), group])
    assert found.to_text() == '(G (n 1 "b c")) (l (a b)) (x 5)'
    assert found.find("x") == 5 and found.find("l") == ["a", "b"]


@pytest.mark.parametrize("text", ["(n1 n2)", "n1 n2"])
def test_networks_are_a_list_or_not(text: str) -> None:
    assert networks(Property.from_text(f"(networks {text})")) == ["n1", "n2"]
    assert networks(Property()) == []


def test_targets_of_actions() -> None:
    assert action(device="d").targets == {"...": "d"}
    assert action(device="d", network="left").targets == {"left": "d"}
    assert action(all=1).targets is None
    assert action(networks=["n", "m"], n="x", m="y").targets == {"n": "x", "m": "y"}
    assert action(kind="park", target="t").targets == {"...": "t"}
    assert action(kind="detach").targets == {}


def test_levels_are_in_order_and_may_be_reversed_on_the_way_down() -> None:
    actions = [action(phase, level) for phase in ("startup", "shutdown") for level in (5, 1, 5)]
    found = Description(devices=[Device("a", "t", (), tuple(actions), NOWHERE)])
    assert [(level, len(all_)) for level, all_ in found.levels("startup")] == [(1, 1), (5, 2)]
    assert [level for level, _ in found.levels("shutdown")] == [1, 5]
    found.reverse = True
    assert [level for level, _ in found.levels("shutdown")] == [5, 1]
    assert [level for level, _ in found.levels("startup")] == [1, 5]


def test_a_target_that_is_no_device_is_told_unless_it_is_handed_in() -> None:
    found = Description(devices=[Device("a", "t", (), (action(device="b"),), NOWHERE)])
    assert ['called "b"' in one.text for one in found.missing()] == [True]
    assert found.missing(["b"]) == []


def test_a_device_gets_its_type_its_name_and_the_prefix() -> None:
    found = Description(portprefix="/r")
    device = Device("a", "t", (Parameter("x", "1", NOWHERE),), (), NOWHERE)
    assert found.options(device) == {"device": "t", "id": "a", "robotName": "/r", "x": 1}
