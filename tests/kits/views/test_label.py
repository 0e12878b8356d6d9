"""What devices say of the numbers that they send: joints, sensors, units; and those that do not."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Any

import pytest

import yarpy
from yarpy.kits.devices.control_board.state import FIELDS
from yarpy.kits.devices.multi_sensor.interface import KINDS
from yarpy.kits.sim.robot import Robot, icub_head
from yarpy.kits.views import label
from yarpy.kits.views.label import learn, rpc_of
from yarpy.kits.views.trace import flat


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    names = yarpy.LocalNames()
    with Robot("/sim", icub_head(), names=names):
        yield names


def device(names: yarpy.LocalNames, name: str, answers: dict[str, Any]) -> yarpy.RpcServer:
    """A port that answers questions, others with [fail]."""

    def answer(message: yarpy.Message) -> Any:
        question = message.as_(yarpy.Bottle).to_text()
        return answers.get(question.replace("[", "").replace("]", ""), [yarpy.Vocab("fail")])

    return yarpy.RpcServer(name, answer, names=names)


@pytest.mark.parametrize(
    ("name", "rpc"),
    [
        ("/icub/head/state:o", "/icub/head/rpc:i"),
        ("/icub/head/stateExt:o", "/icub/head/rpc:i"),
        ("/icub/imu/measures:o", "/icub/imu/rpc:o"),
        ("/head/state", ""),
        ("/x/state:o/y", ""),
    ],
)
def test_whom_to_ask(name: str, rpc: str) -> None:
    assert rpc_of(name) == rpc


def test_joints(names: yarpy.LocalNames) -> None:
    describe = learn("/sim/head/state:o", names)
    assert describe is not None
    labels = describe(yarpy.Vector([0.0] * 6))
    assert labels[:2] == [("neck_pitch", "°"), ("neck_roll", "°")]
    assert len(labels) == 6
    assert describe([0.0] * 5) == []


def test_everything_that_is_measured_of_joints(names: yarpy.LocalNames) -> None:
    describe = learn("/sim/head/stateExt:o", names)
    assert describe is not None
    state = [part for _ in FIELDS for part in ([0.0] * 6, yarpy.Vocab("ok"))]
    labels = describe(state)
    assert len(labels) == len(list(flat(state)))
    assert labels[5:9] == [
        ("eyes_vergence position", "°"),
        ("", ""),
        ("neck_pitch speed", "°/s"),
        ("neck_roll speed", "°/s"),
    ]
    assert labels[7 * 7] == ("neck_pitch duty cycle", "%")
    assert describe(state[:-1]) == describe([*state[:-2], [0.0], 1]) == []


def test_joints_that_slide() -> None:
    names = yarpy.LocalNames()
    answers = {
        "get axes": [yarpy.Vocab("is"), "axes", 2],
        "get name 0": [yarpy.Vocab("is"), "name", "lift"],
        "get type 0": [yarpy.Vocab("is"), "type", yarpy.Vocab("atpr").code],
        "get name 1": [yarpy.Vocab("is"), "name", "turn"],  # of which kind it does not know
    }
    with device(names, "/r/rpc:i", answers):
        describe = learn("/r/state:o", names)
        assert describe is not None
        assert describe([1.0, 2.0]) == [("lift", ""), ("turn", "°")]
        describe = learn("/r/stateExt:o", names)
        assert describe is not None
        state = [part for _ in FIELDS for part in ([0.0] * 2, 0)]
        assert describe(state)[3:5] == [("lift speed", ""), ("turn speed", "°/s")]
        assert describe(state)[18:20] == [("lift torque", ""), ("turn torque", "Nm")]


def test_sensors() -> None:
    names = yarpy.LocalNames()
    sensors = [[[f"s{place}", "frame", ""]] for place, _ in enumerate(KINDS)]
    counts = [count or 2 for count in KINDS.values()]
    value = [[[[0.5] * count, 9.0]] for count in counts]
    with device(names, "/r/rpc:o", {"getMetadata": sensors}):
        describe = learn("/r/measures:o", names)
    assert describe is not None
    labels = describe(value)
    assert len(labels) == len(list(flat(value)))
    assert labels[:5] == [
        ("s0 gyroscope x", "°/s"),
        ("s0 gyroscope y", "°/s"),
        ("s0 gyroscope z", "°/s"),
        ("", ""),
        ("s1 accelerometer x", "m/s²"),
    ]
    for one in (
        ("s3 orientation yaw", "°"),
        ("s4 temperature", "°C"),
        ("s5 force and torque tz", "Nm"),
        ("s6 load 1", ""),
        ("s7 encoder 1", "°"),
        ("s8 skin 0", ""),
        ("s9 position z", "m"),
    ):
        assert one in labels
    assert describe(value[:-1]) == describe([[], *value[1:]]) == []


@pytest.mark.parametrize(
    "answers",
    [
        {},
        {"get axes": ["is", "axes", "many"], "getMetadata": [[], []]},
        {"get axes": ["is"], "getMetadata": [5] * 10},
        {"get axes": ["is", "axes", 1], "getMetadata": [[["x"]]] * 10},
    ],
)
@pytest.mark.parametrize("name", ["/r/state:o", "/r/stateExt:o", "/r/measures:o"])
def test_who_says_nothing_of_use(name: str, answers: dict[str, Any]) -> None:
    names = yarpy.LocalNames()
    with device(names, rpc_of(name), answers):
        assert learn(name, names) is None


def test_nobody_there_and_silence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(label, "TIMEOUT", 0.3)
    names = yarpy.LocalNames()
    assert learn("/gone/state:o", names) is None
    with socket.create_server(("127.0.0.1", 0)) as silent:
        names.register("/r/rpc:i", "tcp", "127.0.0.1", silent.getsockname()[1])
        assert learn("/r/state:o", names) is None
