"""The server for programs of YARP 4: what controlBoard_nwc_yarp of C++ 4.0.0 asked it."""

from typing import Any

import pytest
from support.board import FakeBoard
from support.way_back import way_back
from support.yarp4 import recorded

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp3
from yarpy.kits.devices.control_board import command
from yarpy.kits.devices.control_board.board import Board
from yarpy.kits.devices.control_board.yarp4.functions import ControlBoardMsgs
from yarpy.kits.devices.control_board.yarp4.server import Functions
from yarpy.kits.devices.simulated.joints import SimulatedJoints
from yarpy.wire.message import CALL, Message

ROWS = recorded("board")["client"]


class Head:
    """The board that the C++ client was connected to."""

    axis_names = ("pitch", "yaw", "roll")
    position_limits = ((-30.0, 30.0), (-50.0, 50.0), (-1.0, 1.0))
    velocity_limits = ((0.0, 50.0),) * 3
    max_currents = (1.5,) * 3

    def __init__(self) -> None:
        class Controller:
            gains = [tuple(map(float, range(1, 11)))] * 3

        self.pids = {"pos": Controller()}
        self.variables = {"gain": [1.5, "x"]}
        self.reference_speeds = [10.0, 10.0, 10.0]
        self.angles = [0.0, 1.0, 2.0]
        self.modes = ["pos"] * 3

    def encoders(self) -> list[float]:
        return self.angles

    def position_move(self, joints: list[int], positions: list[float]) -> None:
        for joint, position in zip(joints, positions, strict=True):
            self.angles[joint] = position

    def motion_done(self) -> list[bool]:
        return [True] * 3

    def control_modes(self) -> list[str]:
        return self.modes

    def switch_control_modes(self, joints: list[int], modes: list[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self.modes[joint] = mode

    def velocity_move(self, joints: list[int], speeds: list[float]) -> None:
        pass

    def position_direct(self, joints: list[int], positions: list[float]) -> None:
        pass

    def motor_temperatures(self) -> list[float]:
        return [33.5, 34, 35]

    def torques(self) -> list[float]:
        return [1.0, 2.0, 3.0]

    def apply_torques(self, joints: list[int], torques: list[float]) -> None:
        pass

    def faults(self) -> list[tuple[int, str]]:
        return [(7, "hot"), (0, ""), (0, "")]

    def interaction_modes(self) -> list[str]:
        return ["stif"] * 3

    def duty_cycles(self) -> list[float]:
        return [5.5, 6.5, 7.5]


def ask(server: Any, request: bytes) -> bytes:
    message = Message(CALL, request)
    message.source = "/client"
    message.answer = way_back()
    return b"".join(server(message).to_wire())


def test_cpp_was_answered_like_this() -> None:
    """Its requests in their order, with the commands that it streamed in between."""
    device = Head()
    board = Board(device, "/head")
    server = Functions(board)
    commands = []
    for row in ROWS:
        if row["kind"] == "command":
            message = Message(CALL, bytes.fromhex(row["message"]))
            commands.append(command.read(message.as_(Bottle), 3))
            board.apply(*commands[-1])
        else:
            answer = ask(server, bytes.fromhex(row["request"]))
            assert answer == bytes.fromhex(row["reply"]), Bottle.from_bytes(
                bytes.fromhex(row["request"])
            )
    assert commands == [
        ("velocity_move", [0], [5.5]),
        ("position_direct", [1], [3.25]),
        ("apply_torques", [0], [1.5]),
    ]
    assert device.angles == [0.0, 10.5, 2.0] and device.modes == ["vel", "pos", "pos"]
    assert device.pids["pos"].gains[0][0] == 4.5


def call(server: Any, name: str, *arguments: Any) -> Bottle:
    request = ControlBoardMsgs._methods[f"{name}RPC"].yarp4_ask(arguments)
    return Bottle.from_bytes(to_yarp3(ask(server, bytes(request))))


@pytest.fixture
def server() -> Functions:
    return Functions(Board(FakeBoard(3), "/board"))


def test_every_function_answers(server: Functions) -> None:
    """With arguments that are all zero or empty, and always with a status."""
    for name, method in ControlBoardMsgs._methods.items():
        kinds = [part.kind for part in method.parts]
        zeros = [_zero(kind) for kind in kinds]
        answer = call(server, name.removesuffix("RPC"), *zeros)
        status = answer[0] if isinstance(answer[0], Vocab) else answer[0][0]
        assert status in ("ok", "err2", "err5"), name


def _zero(kind: Any) -> Any:
    from yarpy.kits.thrift.structure import default_of

    return default_of(kind)()


def test_what_is_not_there(server: Functions) -> None:
    assert call(server, "getEncoderOne", 9) == [["err5"], 0.0]
    assert call(server, "getEncoderOne", -1) == [["err5"], 0.0]
    assert call(server, "positionMoveOne", 0, float("nan")) == ["err5"]
    assert call(server, "positionMoveGroup", [0, 1], [1.0]) == ["err5"]
    assert call(server, "positionMoveAll", [1.0]) == ["err5"]
    assert call(server, "getPid", Vocab("pos2").code, 0)[0] == ["err2"]
    assert call(server, "getRemoteVariable", "nothing")[0] == ["err5"]
    empty = Functions(
        Board(type("Bare", (), {"axis_names": ["a"], "encoders": lambda s: [1.5]})(), "/b")
    )
    assert call(empty, "getTorqueRangeAll") == [["err2"], [], []]
    assert call(empty, "stopAll") == ["err2"]
    assert call(empty, "setRefVelocityOne", 0, 1.0) == ["err2"]
    assert call(empty, "isJointBraked", 0) == [["err2"], "fail"]
    assert call(empty, "getNumberOfMotors") == [["err2"], 0]
    assert call(empty, "getEncoderAll") == [["ok"], [1.5]]
    assert call(empty, "getJointType", 0) == [["ok"], Vocab("atrv").code]
    assert call(empty, "getAvailableControlModes", 0) == [["ok"], []]


def test_brakes_and_velocities_at_once() -> None:
    joints = SimulatedJoints(["a", "b"])
    server = Functions(Board(joints, "/b"))
    assert call(server, "setManualBrakeActive", 1, True) == ["ok"]
    assert call(server, "isJointBraked", 1) == [["ok"], "ok"]
    assert call(server, "isJointBraked", 0) == [["ok"], "fail"]
    assert call(server, "setAutoBrakeEnabled", 0, True) == ["ok"]
    assert call(server, "getAutoBrakeEnabled", 0) == [["ok"], "ok"]
    assert call(server, "setManualBrakeActive", 2, True) == ["err5"]
    assert call(server, "setRefVelocityGroup", [1], [2.5]) == ["ok"]
    assert call(server, "getRefVelocityAll") == [["ok"], [0.0, 2.5]]
    assert call(server, "stopOne", 1) == ["ok"]
    assert call(server, "getRefVelocityOne", 1) == [["ok"], 0.0]
    offered = dict(call(server, "getDeviceInterfaces")[1])
    assert offered["iJointBrake"] and offered["iVelocityDirect"]


def test_a_device_that_fails_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    def fails(self: object) -> list[float]:
        raise OSError("the bus is off")

    device = type("Broken", (), {"axis_names": ["a"], "encoders": fails})()
    assert call(Functions(Board(device, "/b")), "getEncoderAll") == [["err5"], []]
    assert "the bus is off" in caplog.text


def test_others_get_fail(server: Functions) -> None:
    assert ask(server, Bottle([Vocab("get"), Vocab("encs")]).to_bytes()) == (
        bytes.fromhex("09010000010000006661696c")
    )


def test_what_is_said_of_controllers() -> None:
    device = Head()
    device.pids["pos"].details = [{"description": "positions", "kp": "V/deg"}] * 3  # type: ignore[attr-defined]
    server = Functions(Board(device, "/head"))
    kind = Vocab("pos1").code
    status, *told = call(server, "getPidExtraInfo", kind, 1)
    assert told == [["positions", "", "", "V/deg", *[""] * 9]], status
    _, everything = call(server, "getPidExtraInfos", kind)
    assert len(everything) == 3
    device.pids["pos"].details = [{"colour": "red"}] * 3  # type: ignore[attr-defined]
    assert "positions" not in str(call(server, "getPidExtraInfo", kind, 1))
