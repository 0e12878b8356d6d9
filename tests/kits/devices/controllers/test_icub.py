"""What the clients of icub-main 2.6 asked its controllers, and what those answered, byte for byte.

`tests/golden/icub_*.json` was recorded between `cartesiancontrollerclient` and
`cartesiancontrollerserver`, and between `gazecontrollerclient` and `iKinGazeCtrl` (C++ YARP 3.9.1):
questions with answers, and what went through other ports. Our clients, told to do the same, ask the
same bytes and no others; our servers answer what C++'s did, but for the numbers.
"""

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices import (
    CartesianController,
    CartesianServer,
    GazeController,
    GazeServer,
    SimulatedArm,
    SimulatedHead,
)
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Encoded

GOLDEN = Path(__file__).parents[3] / "golden"


class Recorded:
    """The ports of a client that stands before recorded answers; `sent`: what it sends to each."""

    def __init__(self, name: str, kind: type[Any]) -> None:
        found = json.loads((GOLDEN / f"icub_{name}.json").read_text(encoding="utf-8"))
        self.wanted = {
            port: {bytes.fromhex(each[0] if port == "rpc" else each) for each in listed}
            for port, listed in found.items()
        }
        self.answers = dict(tuple(map(bytes.fromhex, pair)) for pair in found["rpc"])
        self.sent: dict[str, set[bytes]] = {port: set() for port in found}
        self.client = client = object.__new__(kind)
        client.remote, client._contexts, client._heard = "/recorded", set(), {}
        client._rpc = self
        client._out = {each: self._port(f"{each}:i") for each in kind.COMMANDS}
        client._states = {each: self._state(f"{each}:o") for each in kind.STATES}

    def ask(self, question: Bottle, _: float) -> Any:
        self.sent["rpc"].add(question.to_bytes())
        return self._message(self.answers[question.to_bytes()])

    def hear(self) -> None:
        """Hear all events."""
        for each in self.wanted["events:o"]:
            self.client._event(self._message(each))

    def _message(self, data: bytes) -> Any:
        return SimpleNamespace(as_=lambda kind: kind.from_bytes(data))

    def _port(self, name: str) -> Any:
        return SimpleNamespace(write=lambda bottle: self.sent[name].add(bottle.to_bytes()))

    def _state(self, name: str) -> Any:
        (data,) = self.wanted[name]
        values = tuple(map(float, Bottle.from_bytes(data)))
        return SimpleNamespace(value=lambda: values, time=lambda: 0.0, renew=lambda: None)


def keep(client: Any, name: str, *values: Any) -> None:
    """Set a member to each of these, and read it."""
    for value in values:
        setattr(client, name, value)
        getattr(client, name)


def test_hand() -> None:
    recorded = Recorded("cartesian", CartesianController)
    hand: CartesianController = recorded.client
    heard: list[Any] = []
    goal, near = (-0.1, -0.1, -0.15), (0.01 - 0.1, -0.1, -0.15)
    assert hand.info()["arm_type"] == "left_v2.5" and hand.is_on() and not hand.motion_done()
    here = hand.pose()
    assert here.position == pytest.approx((-0.0616, -0.0896, -0.1672), abs=1e-4)
    assert hand.pose(0).position == pytest.approx((0.0, 0.0, 0.032))
    assert hand.pose(3).time == pytest.approx(1795947009, abs=10)
    keep(hand, "trajectory_time", 0.5)
    keep(hand, "tolerance", 0.002)
    used = hand.dof
    assert used == (0.0,) * 3 + (1.0,) * 7
    hand.dof = [1, *used[1:]]
    hand.dof = used
    hand.rest_position = rest = hand.rest_position
    assert rest[6] == 5.5
    hand.rest_weights = hand.rest_weights
    hand.change_limits(0, *hand.limits(0))
    hand.tracking = True
    assert hand.tracking
    hand.tracking = False
    hand.reference_mode = False
    assert not hand.reference_mode
    hand.reference_mode = True
    hand.priority = "orientation"
    assert hand.priority == "orientation"
    hand.priority = "position"
    found = hand.solve(goal)
    assert found.position == pytest.approx(goal, abs=1e-4) and len(found.joints) == 10
    hand.solve(goal, here.orientation)
    hand.solve(goal, start=found.joints)
    hand.solve(goal, here.orientation, found.joints)
    hand.on_event("motion-ongoing", heard.append, 0.5)
    hand.on_event("motion-done", heard.append)
    hand.go_to(goal, seconds=0.5, confirmed=True)
    assert hand.desired() == found
    recorded.hear()
    assert {(event.kind, event.share) for event in heard} == {
        *(("motion-ongoing", 0.5), ("motion-done", None)),
    }
    hand.off_event("motion-ongoing", 0.5)
    hand.go_to(near, seconds=0.5)
    turned = _goal(recorded, "rpc", "full")
    hand.go_to(near, turned, 0.5)
    hand.go_to(near, turned, confirmed=True)
    hand.move((0.01, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    assert hand.task_velocities() == ((0.0,) * 3, (0.0,) * 4)
    assert hand.joint_velocities() == (0.0,) * 7
    hand.stop()
    keep(hand, "tip", ((0.0, 0.0, 0.05), (0.0, 0.0, 1.0, 0.0)))
    hand.tip = (0.0,) * 3, (0.0,) * 4
    kept = hand.store_context()
    hand.trajectory_time = 2.0
    hand.restore_context(kept)
    hand.delete_context(kept)
    hand.tweak(hand.tweaks())
    hand.delete_context()
    assert recorded.sent["rpc"] == recorded.wanted["rpc"]
    assert recorded.sent["command:i"] == recorded.wanted["command:i"]


def _goal(recorded: Recorded, port: str, kind: str) -> list[float]:
    """The orientation that C++ was told to go to."""
    for each in map(Bottle.from_bytes, recorded.wanted[port]):
        if [*map(str, each[:2])] == ["go", kind]:
            return [*each[3][3:]]
    raise AssertionError(kind)


def test_gaze() -> None:
    recorded = Recorded("gaze", GazeController)
    gaze: GazeController = recorded.client
    goal, heard = (-1.0, 0.1, 0.35), list[Any]()
    assert gaze.info()["head_version"] == "2.5" and not gaze.motion_done()
    for what, side in (("left", -0.034), ("right", 0.034), ("head", 0.0)):
        assert gaze.pose(what).position == pytest.approx((-0.0564, side, 0.34685))
    assert len(gaze.fixation_point()) == len(gaze.angles()) == 3 and len(gaze.joints()) == 9
    assert (gaze.vor_gain, gaze.ocr_gain) == (0.0, 1.0)
    for name, value in {
        "neck_time": 0.6,
        "eyes_time": 0.3,
        "saccade_inhibition": 0.3,
        "saccade_angle": 12.0,
        "neck_tolerance": 2.0,
    }.items():
        keep(gaze, name, value)
        assert getattr(gaze, name) == value
    gaze.neck_time, gaze.vor_gain, gaze.ocr_gain = 2.0, 0.5, 0.25
    keep(gaze, "saccades", True, False)
    keep(gaze, "tracking", True, False)
    for value in (True, False):
        with pytest.raises(LocalProtocolError):  # it had no inertial unit
            gaze.stabilization = value
    assert not gaze.stabilization
    gaze.on_event("motion-ongoing", heard.append, 0.5)
    gaze.look_at(goal, confirmed=True)
    recorded.hear()
    assert [event.share for event in heard] == [0.5]
    gaze.off_event("motion-ongoing", 0.5)
    gaze.look_at((-1.2, -0.1, 0.3))
    gaze.turn_to((10, 5, 3))
    gaze.turn_to((-5, 0, 0), relative=True)
    gaze.turn_to((0, 0, 5), confirmed=True)
    gaze.turn_to((5, 0, 0), relative=True, confirmed=True)
    gaze.look_at_pixel("left", (170, 120), 1.0)
    gaze.look_at_pixel("right", (150, 110), 1.0, confirmed=True)
    for confirmed in (False, True):
        gaze.look_at_pixel("left", (165, 118), vergence=6.0, confirmed=confirmed)
    gaze.look_at_pixels((170, 120), (150, 120))
    gaze.look_at_pixels((165, 120), (155, 120), confirmed=True)
    pixel = gaze.pixel("left", goal)
    assert gaze.point("left", pixel, 1.0) == pytest.approx((-1.0486, 0.1066, 0.35), abs=1e-3)
    assert gaze.point_on_plane("left", pixel, (1, 0, 0, 1)) == pytest.approx(goal)
    gaze.point_in_direction((5, 5, 5))
    assert gaze.direction(goal) == pytest.approx((6.05, 0.19, 4.1), abs=0.01)
    gaze.pixel("right", goal)
    (both,) = (each[3] for each in _asked(recorded, "get", "3D", "stereo"))
    assert gaze.triangulate(both[:2], both[2:]) == pytest.approx(goal, abs=1e-4)
    for joint, limit in (("pitch", (-20, 10)), ("roll", (-5, 5)), ("yaw", (-20, 20))):
        gaze.bind_neck(joint, 3 if joint == "pitch" else 0)
        gaze.bind_neck(joint, *limit)
        gaze.neck_range(joint)
        gaze.free(joint)
    assert gaze.neck_range("roll") == (-5.0, 5.0)
    gaze.bind_eyes(5.0)
    assert gaze.bound_vergence() == 5.0
    gaze.free("eyes")
    assert len(gaze.desired_joints()) == len(gaze.joint_velocities()) == 6
    gaze.change_stereo_options(gaze.stereo_options())
    gaze.stop()
    kept = gaze.store_context()
    gaze.restore_context(kept)
    gaze.delete_context(kept)
    for port, sent in recorded.sent.items():
        if not port.endswith(":o"):
            assert sent == recorded.wanted[port], port


def _asked(recorded: Recorded, *words: str) -> list[Bottle]:
    """The questions that begin with these words."""
    found = map(Bottle.from_bytes, recorded.wanted["rpc"])
    return [each for each in found if [*map(str, each[: len(words)])] == [*words]]


#: What depends on the robot: how many joints it has, and whether it has an inertial unit.
OTHERWISE = ("set resp", "set resw", "set twea", "set stab")


@pytest.mark.parametrize(
    ("name", "server", "device"),
    [("cartesian", CartesianServer, SimulatedArm), ("gaze", GazeServer, SimulatedHead)],
)
def test_servers(names: Any, name: str, server: Any, device: Callable[[], Any]) -> None:
    found = json.loads((GOLDEN / f"icub_{name}.json").read_text(encoding="utf-8"))
    with (
        server("/s", device(), 0.05, names=names),
        RpcClient(f"/s/{server.RPC}", names=names) as client,
    ):
        for question, answer in found["rpc"]:
            asked = Bottle.from_bytes(bytes.fromhex(question))
            told = client.ask(Encoded(bytes.fromhex(question)), 20.0).as_(Bottle)
            words = " ".join(map(str, asked[:2]))
            starts = any(
                [*map(str, each[:1])] == ["q"] for each in asked if isinstance(each, Bottle)
            )
            if words not in OTHERWISE and not starts:
                assert _form(told) == _form(Bottle.from_bytes(bytes.fromhex(answer))), words


def _form(value: Any) -> Any:
    """What an answer is but for its numbers and the lists that a controller has of its own."""
    if isinstance(value, Bottle):
        if value and all(isinstance(each, (int, float)) for each in value):
            return "numbers"
        if all(isinstance(each, Bottle) and len(each) > 1 for each in value) and not any(
            isinstance(each[0], Vocab) for each in value
        ):
            return "options"
        return [_form(each) for each in value]
    return "number" if isinstance(value, (int, float)) else (type(value), str(value))
