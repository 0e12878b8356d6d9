"""A client of a board: with what can be asked, commanded and adjusted; and boards behind boards."""

import math
import threading
from contextlib import ExitStack, contextmanager

import numpy as np
import pytest
from support.board import Bare, FakeBoard
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
    UnknownName,
)
from yarpy.kits.devices.control_board.client import ControlBoard
from yarpy.kits.devices.control_board.interface import ControlBoardLike, ControlMode, Gains
from yarpy.kits.devices.control_board.server import ControlBoardServer
from yarpy.nameserver.local import LocalNames


@contextmanager
def clients_of(device, kind, names=None):
    """Give a client of the device; one of a server of a client of it ("relayed"); or one that finds
    the functions of YARP 4 only, and is taken for a program of it ("newer")."""
    names = names or LocalNames()
    with ExitStack() as stack:
        stack.enter_context(ControlBoardServer("/head", device, 0.005, names=names))
        if kind == "newer":
            patch = stack.enter_context(pytest.MonkeyPatch.context())
            patch.setattr("yarpy.port.port.MessagePort._is_yarp4", lambda port, target: True)
            names.unregister("/head/rpc:i")
        client = stack.enter_context(ControlBoard("/head", timeout=HANG, names=names))
        if kind == "relayed":
            stack.enter_context(ControlBoardServer("/relay", client, 0.005, names=names))
            client = stack.enter_context(ControlBoard("/relay", timeout=HANG, names=names))
        yield client


KINDS = ("head", "relayed", "newer")


@pytest.fixture
def device():
    return FakeBoard(3)


@pytest.fixture
def head(device, names):
    """A client of the device."""
    with clients_of(device, "head", names) as head:
        yield head


@pytest.fixture(params=KINDS)
def board(device, request):
    with clients_of(device, request.param) as board:
        yield board


@pytest.fixture(scope="module", params=KINDS)
def lasting(request):
    """A device and its client, for tests of one call each."""
    device = FakeBoard(3)
    with clients_of(device, request.param) as board:
        yield device, board


def test_five_lines(device, head):
    head.switch_control_modes(head.axis_names, "pos")
    head.position_move("joint1", 10.0)
    head.wait_motion_done(timeout=HANG)
    assert head.encoders() == [0.0, 10.0, 0.0]


def test_it_is_a_whole_board():
    members = {*vars(ControlBoardLike), *ControlBoardLike.__annotations__}
    public = {name for name in members if not name.startswith("_")}
    assert {name for name in public if not hasattr(ControlBoard, name)} == set()


def test_measurements(device, board):
    device.where[:] = [1.0, 2.0, 3.0]
    wait_until(lambda: board.encoders() == [1.0, 2.0, 3.0])
    assert board.axes == 3
    assert board.axis_names == ["joint0", "joint1", "joint2"]
    assert board.axis_types == ["revolute", "revolute", "prismatic"]
    assert board.timestamps() == [0.0, 0.0, 0.0]
    assert board.encoder_speeds() == board.encoder_accelerations() == [0.0, 0.0, 0.0]
    assert board.motor_encoders() == [10.0, 20.0, 30.0]
    assert board.motor_speeds() == board.motor_accelerations() == [0.0, 0.0, 0.0]
    assert board.torques() == [0.0, 0.0, 0.0]
    assert board.currents() == [3300.0, 3400.0, 3500.0]
    assert board.duty_cycles() == [33.0, 34.0, 35.0]
    assert board.control_modes() == ["pos", "pos", "pos"] == [ControlMode.POSITION] * 3
    assert board.interaction_modes() == ["stif", "stif", "stif"]
    assert board.supply_voltages() == [24.0, 24.0, 24.0]
    assert board.motor_temperatures() == [40.0, 41.0, 42.0]
    assert board.amplifier_status() == [0, 1, 2]
    assert board.faults() == [(0, ""), (1, "test1 torque"), (2, "test2 torque")]
    assert board.motion_done() == [True, True, True]


COMMANDS = [
    # what is called, what the device hears
    (("position_move", 1, 5), ("position_move", [1], [5.0])),
    (("position_move", "joint2", 5.5), ("position_move", [2], [5.5])),
    (("position_move", [0, "joint2"], [5.5, 6.5]), ("position_move", [0, 2], [5.5, 6.5])),
    (("position_move", [2, 1, 0], 1.0), ("position_move", [2, 1, 0], [1.0, 1.0, 1.0])),
    (("position_move", range(3), (1, 2, 3)), ("position_move", [0, 1, 2], [1.0, 2.0, 3.0])),
    (("position_move", np.arange(3), np.ones(3)), ("position_move", [0, 1, 2], [1.0] * 3)),
    (("position_move", np.int64(1), np.float32(2)), ("position_move", [1], [2.0])),
    (("position_direct", 0, 5.0), ("position_direct", [0], [5.0])),
    (("position_direct", [0, 1], [5.0, 6.0]), ("position_direct", [0, 1], [5.0, 6.0])),
    (("velocity_move", range(3), 5.0), ("velocity_move", [0, 1, 2], [5.0, 5.0, 5.0])),
    (("apply_torques", [2, 0], [1.0, 2.0]), ("apply_torques", [2, 0], [1.0, 2.0])),
    (("apply_currents", 2, 0.5), ("apply_currents", [2], [0.5])),
    (("apply_duty_cycles", range(3), 1.5), ("apply_duty_cycles", [0, 1, 2], [1.5] * 3)),
    (("stop", 1), ("stop", [1])),
    (("stop",), ("stop", [0, 1, 2])),
    (("stop", ["joint0", "joint1"]), ("stop", [0, 1])),
    (("switch_control_modes", 1, "vel"), ("switch_control_modes", [1], ["vel"])),
    (("switch_control_modes", [0, 1], ["vel", ControlMode.IDLE]),
     ("switch_control_modes", [0, 1], ["vel", "idl"])),
    (("switch_interaction_modes", [0, 1, 2], "comp"),
     ("switch_interaction_modes", [0, 1, 2], ["comp"] * 3)),
    (("preset_encoders", range(3), 0), ("preset_encoders", [0, 1, 2], [0.0] * 3)),
    (("preset_motor_encoders", 1, 4), ("preset_motor_encoders", [1], [4.0])),
    (("enable_amplifiers", 1), ("enable_amplifiers", [1])),
    (("disable_amplifiers", "joint0"), ("disable_amplifiers", [0])),
    (("calibrate_joint", "joint1", 4, [1, 2, 3]), ("calibrate_joint", 1, 4, [1.0, 2.0, 3.0])),
    (("calibrate",), ("calibrate", [0, 1, 2])),
    (("home", 2), ("home", [2])),
    (("park",), ("park", [0, 1, 2])),
    (("quit_calibration",), ("quit_calibration",)),
    (("quit_parking",), ("quit_parking",)),
]  # fmt: skip


@pytest.mark.parametrize(("call", "heard"), COMMANDS, ids=lambda value: value[0])
def test_commands(lasting, call, heard):
    device, board = lasting
    device.done.clear()
    method, *arguments = call
    getattr(board, method)(*arguments)
    wait_until(lambda: device.done, HANG, f"{call} arrived")
    assert device.done == [heard]


def test_relative_move(device, board):
    board.relative_move(1, -2.0)
    wait_until(lambda: device.done)
    assert device.done == [("position_move", [1], [-2.0])]


def test_targets(device, board):
    board.position_move(1, 5.0)
    board.velocity_move(2, 3.0)
    board.apply_torques(range(3), 0.5)
    wait_until(lambda: len(device.done) == 3)
    assert board.position_targets() == [0.0, 5.0, 0.0]
    assert board.velocity_targets() == [0.0, 0.0, 3.0]
    assert board.torque_targets() == [0.5, 0.5, 0.5]
    assert board.current_targets() == board.duty_cycle_targets() == [0.0, 0.0, 0.0]
    assert board.direct_targets() == [0.0, 5.0, 0.0]  # where it is


ADJUSTED = {
    "reference_speeds": (1.0, 2.0, 3.0),
    "reference_accelerations": (1.0, 2.0, 3.0),
    "position_limits": ((-1.0, 1.0), (-2.0, 2.0), (-3.0, 3.0)),
    "velocity_limits": ((-1.0, 1.0), (-2.0, 2.0), (-3.0, 3.0)),
    "max_currents": (1.0, 2.0, 3.0),
    "nominal_currents": (1.0, 2.0, 3.0),
    "peak_currents": (1.0, 2.0, 3.0),
    "pwm_limits": (1.0, 2.0, 3.0),
    "temperature_limits": (1.0, 2.0, 3.0),
    "gearbox_ratios": (1.0, 2.0, 3.0),
    "counts_per_revolution": (1.0, 2.0, 3.0),
    "motor_torque_parameters": ((1.0,) * 9, (2.0,) * 9, (3.0,) * 9),
    "impedances": ((-1.0, 1.0), (-2.0, 2.0), (-3.0, 3.0)),
    "impedance_offsets": (1.0, 2.0, 3.0),
}


@pytest.mark.parametrize("member", ADJUSTED)
def test_adjusting(lasting, member):
    device, board = lasting
    values = ADJUSTED[member]
    assert getattr(board, member) != values
    setattr(board, member, [*values])
    assert getattr(board, member) == values
    assert [*getattr(device, member)] == [*values]


def test_what_cannot_be_adjusted(board):
    assert board.torque_ranges[1] == (-6.0, 5.0)
    assert board.current_ranges[2] == (-2.0, 4.0)
    assert board.impedance_ranges[0] == (0.0, 1.0, 0.0, 0.5)
    assert board.motor_torque_parameters[0].viscous_negative == 5.0
    with pytest.raises(AttributeError, match="only be read"):
        board.torque_ranges = [(0.0, 1.0)] * 3


def test_controllers(device, board):
    pids = board.pids["vel"]
    assert pids.gains[0] == Gains(*map(float, range(1, 11)))
    pids.gains = [Gains(kp=2.0)] * 3
    pids.targets = (1.0, 2.0, 3.0)
    pids.enabled = (True, False, True)
    pids.reset([2])
    assert [Gains(*gains).kp for gains in device.pids["vel"].gains] == [2.0, 2.0, 2.0]
    assert [*device.pids["vel"].targets] == [1.0, 2.0, 3.0]
    assert [*device.pids["vel"].enabled] == [True, False, True]
    assert device.pids["vel"].was_reset == [2]
    assert pids.errors() == [0.5] * 3 and pids.outputs() == [0.25] * 3
    with pytest.raises(KeyError):
        board.pids["bogus"]


def test_variables(device, board):
    assert dict(board.variables) == {"gain": [1.5, "low"], "limit": [7]}
    board.variables["gain"] = [2, "high"]
    assert device.variables["gain"] == [2, "high"]
    with pytest.raises(KeyError):
        board.variables["nothing"]


def test_calibration_done(board):
    assert board.calibration_done("joint0")
    assert not board.calibration_done(1)


def test_what_a_board_has_not(names):
    with (
        ControlBoardServer("/head", Bare(), 0.005, names=names),
        ControlBoard("/head", timeout=HANG, names=names) as head,
    ):
        assert head.encoders() == [1.5, -2.0]
        with pytest.raises(LocalProtocolError, match="does not measure torques"):
            head.torques()
        with pytest.raises(LocalProtocolError, match=r'"/head" refuses \[set\] \[pos\] 0 1.0'):
            head.position_move(0, 1.0)
        with pytest.raises(LocalProtocolError):
            head.wait_motion_done()
        assert not hasattr(head, "nonsense")


def test_bad_arguments_are_not_sent(device, head):
    for joints in (3, -1, [0, 7]):
        with pytest.raises(IndexError, match="joints 0 to 2"):
            head.position_move(joints, 1.0)
    with pytest.raises(LookupError, match='no joint "elbow", it has joint0, joint1, joint2'):
        head.position_move("elbow", 1.0)
    with pytest.raises(ValueError, match="2 values for 3 joints"):
        head.velocity_move(range(3), [1.0, 2.0])
    with pytest.raises(ValueError, match="2 values for 3 joints"):
        head.reference_speeds = [1.0, 2.0]
    with pytest.raises(TypeError):
        head.position_move(1.5, 2.0)
    with pytest.raises(LocalProtocolError, match="refuses"):
        head.position_move(0, math.nan)
    assert device.done == []


def test_waiting_for_a_motion_that_does_not_end(device, head):
    device.motion_done = lambda: [True, False, True]
    with pytest.raises(Timeout, match=r"still moving after 0\.05 s: joint1"):
        head.wait_motion_done(0.05)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp"])
def test_carriers(device, names, carrier):
    with (
        ControlBoardServer("/head", device, 0.005, names=names) as server,
        ControlBoard("/head", "/me", carrier=carrier, timeout=HANG, names=names) as head,
    ):
        head.velocity_move(0, 2.0)
        wait_until(lambda: device.done)
        assert head.encoders() == [0.0, 0.0, 0.0]
        assert names.query("/me/command:o") is not None
        assert server._command.inputs[0].carrier == carrier
        assert server._state_ext.outputs[0].carrier == carrier


def test_another_protocol(names):
    def answer(message):
        return yarpy.Bottle.from_text("[prot] 2 0 0 [ok]")

    with (
        yarpy.RpcServer("/head/rpc:i", answer, names=names),
        yarpy.Port("/head/command:i", callback=lambda message: None, names=names),
        yarpy.Port("/head/stateExt:o", names=names),
    ):
        with pytest.raises(RemoteProtocolError, match=r"version 2\.0\.0 .* not 1\.9\.0"):
            ControlBoard("/head", "/me", names=names)
        assert names.query("/me/rpc:o") is None
        assert names.query("/me/stateExt:i") is None


def test_nobody_there(names):
    with pytest.raises(UnknownName, match="/head/rpc:i"):
        ControlBoard("/head", names=names)


def test_plain_ports_are_a_board_too(names):
    """As with C++ clients: three ports with ordinary Bottles will do."""
    replies = {
        "[get] [prot]": "[prot] 1 9 0 [ok]",
        "[get] [axes]": "[is] [axes] 2 [tsta] 0 1.0 [ok]",
    }
    state = "(1.0 2.0) [ok]" + " (0.0 0.0) [ok]" * 8 + " ([pos] [pos]) [ok] (0 0) 0"
    with (
        yarpy.RpcServer(
            "/head/rpc:i",
            lambda m: yarpy.Bottle.from_text(replies[m.as_(yarpy.Bottle).to_text()]),
            names=names,
        ),
        yarpy.Port("/head/command:i", callback=lambda message: None, names=names),
        yarpy.Port("/head/stateExt:o", names=names) as output,
        ControlBoard("/head", timeout=HANG, names=names) as head,
    ):
        output.write(yarpy.Bottle.from_text(state), wait=True)
        assert head.encoders() == [1.0, 2.0]
        assert head.control_modes() == ["pos", "pos"]
        with pytest.raises(LocalProtocolError):
            head.interaction_modes()


def test_a_robot_that_was_restarted(names):
    with ControlBoardServer("/head", FakeBoard(2), 0.005, names=names) as server:
        head = ControlBoard("/head", timeout=HANG, names=names)
        with head:
            assert head.encoders() == [0.0, 0.0]
            server.close()
            with pytest.raises((LinkClosed, UnknownName)):
                for _ in range(1000):
                    head.velocity_move(0, 1.0)
                    yarpy.wait_for("/nobody", timeout=0.01, names=names)
            device = FakeBoard(2)
            device.where = [7.0, 8.0]
            with ControlBoardServer("/head", device, 0.005, names=names):
                wait_until(lambda: head.encoders() == [7.0, 8.0])
                head.position_move(0, 5.0)
                assert device.where == [5.0, 8.0]
                head.velocity_move(1, 4.0)
                wait_until(lambda: ("velocity_move", [1], [4.0]) in device.done)


def test_closing_leaves_nothing(device, names):
    with ControlBoardServer("/head", device, names=names):
        before = {thread.name for thread in threading.enumerate()}
        head = ControlBoard("/head", "/me", names=names)
        assert repr(head) == "<ControlBoard /head, 3 joints>"
        head.close()
        head.close()
        wait_until(lambda: {thread.name for thread in threading.enumerate()} <= before)
        for port in ("rpc:o", "command:o", "stateExt:i"):
            assert names.query(f"/me/{port}") is None
