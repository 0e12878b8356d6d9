"""The client of a board of YARP 4: what controlBoard_nws_yarp of C++ 4.0.0 answered it."""

import pytest
from support.yarp4 import Replay

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.kits.devices.control_board.interface import Gains
from yarpy.kits.devices.control_board.yarp4.functions import ControlBoardMsgs
from yarpy.kits.devices.control_board.yarp4.requests import FunctionRequests
from yarpy.kits.thrift.client import client_class


@pytest.fixture
def replay() -> Replay:
    return Replay("board")


@pytest.fixture
def board(replay: Replay, monkeypatch: pytest.MonkeyPatch) -> FunctionRequests:
    client = client_class(ControlBoardMsgs)(replay, 1.0)
    monkeypatch.setattr(ControlBoardMsgs, "connect", lambda *args, **options: client)
    made = FunctionRequests("/arm", "/local", None)
    assert made.count_axes() == 3
    return made


def test_what_is_asked_and_answered(board: FunctionRequests) -> None:
    assert board.version() == (0, 4, 0, 0)
    assert board.read("axis_names") == ["a", "b", "c"]
    assert board.read("axis_types") == ["revolute"] * 3
    assert board.read("motor_temperatures") == [37.5, 38.5, 39.5]
    assert board.read("amplifier_status") == [0, 0, 0]
    assert board.read("faults") == [(0, "")] * 3
    assert board.read("position_limits") == [(-10.0, 10.5)] * 3
    assert board.read("current_ranges") == [(-3.5, 3.5)] * 3
    assert board.read("impedance_ranges") == [(1.0, 10.0, 2.0, 20.0)] * 3
    assert board.read("motor_torque_parameters")[0][:4] == (1.5, 1.0, 1.5, 1.0)
    assert board.read("motion_done") == [False] * 3


def test_what_is_set(board: FunctionRequests) -> None:
    joints = [0, 1, 2]
    board.write("reference_speeds", joints, [21.5, 22.0, 23.0])
    assert board.read("reference_speeds") == [21.5, 22.0, 23.0]
    board.write("position_move", [1], [2.25])
    board.write("position_move", [0, 2], [1.5, 2.5])
    board.write("position_move", joints, [1.5, 2.5, 3.5])
    board.write("position_limits", joints, [(-10.0, 10.5)] * 3)
    board.write("switch_control_modes", [0], ["vel"])
    board.write("motor_torque_parameters", joints, [[1.5] * 9] * 3)
    board.write("stop", joints, None)
    board.write("preset_encoders", [0], [2.0])
    with pytest.raises(LocalProtocolError, match="whole degrees for one encoder"):
        board.write("preset_encoders", [0], [1.5])
    with pytest.raises(AttributeError, match="can only be read"):
        board.write("encoders", [0], [1.5])


def test_controllers(board: FunctionRequests) -> None:
    assert board.read_pid("pos", "errors") == [0.1] * 3
    assert board.read_pid("pos", "enabled") == [False] * 3
    board.write_pid("pos", "gains", [0, 1, 2], [[1.5] * 10] * 3)
    assert board.read_pid("pos", "gains")[2] == Gains(*(1.5,) * 10)


def test_refusals_say_what_and_why(board: FunctionRequests, replay: Replay) -> None:
    with pytest.raises(LocalProtocolError) as refused:
        board.read("counts_per_revolution")
    assert str(refused.value) == (
        '"/arm" refuses getMotorEncoderCountsPerRevolution(0): it cannot do this'
    )
    with pytest.raises(LocalProtocolError, match="it is not ready yet"):
        board.variable_names()
    with pytest.raises(LocalProtocolError, match="it is not ready yet"):
        board.calibrator("calibrate", [0, 1, 2])
    assert board.calibration_done(0) is False
    with pytest.raises(LocalProtocolError, match="does not tell control_modes"):
        board.read("control_modes")
    with pytest.raises(ValueError, match="3 parameters, not 4"):
        board.calibrate_joint(0, 1, [1, 2, 3, 4])
    board.axes = 2
    with pytest.raises(RemoteProtocolError, match="returns no motor temperatures: 3 values"):
        board.read("motor_temperatures")
