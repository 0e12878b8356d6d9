"""The parameters of a node."""

from typing import Any

import pytest

from yarpy.errors import UnknownName
from yarpy.peers.ros2.parameter.store import Change, Descriptor, Parameters


@pytest.fixture
def told() -> list[Change]:
    return []


@pytest.fixture
def all_(told: list[Change]) -> Parameters:
    found = Parameters(told.append)
    found.declare("gain", 2.5, Descriptor(low=0.0, high=10.0, step=0.5))
    found.declare("arm.joint.max", 3)
    found.declare("arm.name", "left", Descriptor(read_only=True))
    found.declare("free", 1, Descriptor(dynamic=True))
    return found


def test_what_is_declared(all_: Parameters, told: list[Change]) -> None:
    assert (all_.get("gain"), all_.get("arm.name")) == (2.5, "left")
    assert [*all_] == ["arm.joint.max", "arm.name", "free", "gain"]
    assert told[0] == Change(new={"gain": 2.5})
    assert all_.described("gain")[0] == 3
    for name in ("gain", ""):
        with pytest.raises(ValueError, match="cannot be declared"):
            all_.declare(name, 1)
    with pytest.raises(TypeError):
        all_.declare("x", object())
    with pytest.raises(UnknownName):
        all_.get("x")


def test_changes(all_: Parameters, told: list[Change]) -> None:
    all_.set({"gain": 3.0, "free": "text"})
    assert (all_.get("gain"), all_.get("free")) == (3.0, "text")
    assert told[-1] == Change(changed={"gain": 3.0, "free": "text"})
    all_.undeclare("free")
    assert told[-1] == Change(deleted={"free": "text"})
    assert not all_.has("free")


@pytest.mark.parametrize(
    ("name", "value", "error", "why"),
    [
        ("gain", 3, TypeError, "double: write 3.0"),
        ("gain", "x", TypeError, "not a string"),
        ("gain", 11.0, ValueError, "from 0.0 to 10.0"),
        ("gain", 0.3, ValueError, "steps of 0.5"),
        ("arm.name", "right", ValueError, "read-only"),
        ("nobody", 1, UnknownName, "no parameter"),
    ],
)
def test_what_is_refused_changes_nothing(
    all_: Parameters, told: list[Change], name: str, value: Any, error: Any, why: str
) -> None:
    before = len(told)
    with pytest.raises(error, match=why):
        all_.set({"arm.joint.max": 7, name: value})
    assert all_.get("arm.joint.max") == 3
    assert len(told) == before


def test_who_watches_may_refuse(all_: Parameters) -> None:
    seen = []

    def watcher(changes: dict[str, Any]) -> None:
        seen.append(changes)
        if changes.get("gain") == 9.0:
            raise ValueError("not that one")

    all_.watch(watcher)
    all_.set({"gain": 1.0})
    with pytest.raises(ValueError, match="not that one"):
        all_.set({"gain": 9.0})
    assert all_.get("gain") == 1.0
    assert seen == [{"gain": 1.0}, {"gain": 9.0}]


@pytest.mark.parametrize(
    ("prefixes", "depth", "names"),
    [
        ([], 0, ["arm.joint.max", "arm.name", "free", "gain"]),
        ([], 1, ["free", "gain"]),
        ([], 2, ["arm.name", "free", "gain"]),
        (["arm"], 0, ["arm.joint.max", "arm.name"]),
        (["arm"], 1, ["arm.name"]),
        (["arm.joint", "gain"], 0, ["arm.joint.max", "gain"]),
        (["ar"], 0, []),
    ],
)
def test_names_below_prefixes(
    all_: Parameters, prefixes: list[str], depth: int, names: list[str]
) -> None:
    assert all_.names(prefixes, depth) == names
