"""A yarpy board behind the board server of C++, which reaches it with the client of C++.

    ControlBoard (yarpy) -> controlBoard_nws_yarp -> remote_controlboard -> ControlBoardServer

Whatever goes through has been spoken by yarpy to a C++ server, and by a C++ client to yarpy. The
commands and measurements come over udp, as C++ wants it.
"""

import pytest
from support.board import FakeBoard
from support.cpp import CppYarp
from support.cpp_device import cpp_device
from support.peer import brings
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices import ControlBoard, ControlBoardServer
from yarpy.kits.devices.control_board.interface import Gains


@pytest.fixture(scope="module")
@brings("cpp", "g++")
def chain(network: CppYarp):
    """The device at the far end, and our client at the near end."""
    device = FakeBoard(3)
    with ControlBoardServer("/ours", device, 0.01) as server:
        host = cpp_device(
            network,
            "controlBoard_nws_yarp",
            subdevice="remote_controlboard",
            remote="/ours",
            local="/between",
            name="/cpp",
            period=0.01,
        )
        process = host.__enter__()
        try:
            carriers = {"udp" if network.version < (4, 0) else "fast_tcp"}
            wait_until(lambda: {link.carrier for link in server._state_ext.outputs} == carriers)
            wait_until(lambda: {link.carrier for link in server._command.inputs} == carriers)
            with ControlBoard("/cpp", carrier="udp", timeout=HANG) as board:
                yield device, board
        except AssertionError:
            print(process.stdout, process.stderr)
            raise
        finally:
            host.__exit__(None, None, None)


@pytest.fixture
def device(chain):
    chain[0].__init__(3)
    return chain[0]


@pytest.fixture
def board(chain, device):
    return chain[1]


def test_measurements(network: CppYarp, device, board):
    device.where[:] = [1.0, 2.0, 3.0]
    wait_until(lambda: board.encoders() == [1.0, 2.0, 3.0])
    assert board.axes == 3
    assert board.axis_names == ["joint0", "joint1", "joint2"]
    assert board.axis_types == ["revolute", "revolute", "prismatic"]
    assert board.motor_encoders() == [10.0, 20.0, 30.0]
    assert board.torques() == [0.0, 0.0, 0.0]
    assert board.currents() == [3300.0, 3400.0, 3500.0]
    assert board.duty_cycles() == [33.0, 34.0, 35.0]
    if network.version < (4, 0):  # whose client asks its own stream for another word
        assert board.motor_temperatures() == [40.0, 41.0, 42.0]
    assert board.motion_done() == [True, True, True]


def test_modes(device, board):
    board.switch_control_modes([0, 2], ["vel", "torq"])
    board.switch_interaction_modes(1, "comp")
    wait_until(lambda: board.control_modes() == ["vel", "pos", "torq"])
    wait_until(lambda: board.interaction_modes() == ["stif", "comp", "stif"])
    assert device.modes == ["vel", "pos", "torq"]


# What goes through the classes of C++ as it is.
COMMANDS = [
    (("position_move", 1, 5.0), ("position_move", [1], [5.0])),
    (("position_move", [0, 2], [5.5, 6.5]), ("position_move", [0, 2], [5.5, 6.5])),
    (("position_move", range(3), 1.0), ("position_move", [0, 1, 2], [1.0, 1.0, 1.0])),
    (("relative_move", 1, -2.0), ("position_move", [1], [-2.0])),
    (("relative_move", range(3), 2.0), ("position_move", [0, 1, 2], [2.0, 2.0, 2.0])),
    (("position_direct", 0, 5.0), ("position_direct", [0], [5.0])),
    (("position_direct", [0, 2], [5.0, 6.0]), ("position_direct", [0, 2], [5.0, 6.0])),
    (("position_direct", range(3), 4.0), ("position_direct", [0, 1, 2], [4.0, 4.0, 4.0])),
    (("velocity_move", 2, 5.0), ("velocity_move", [2], [5.0])),
    (("velocity_move", [0, 1], 5.0), ("velocity_move", [0, 1], [5.0, 5.0])),
    (("velocity_move", range(3), 5.0), ("velocity_move", [0, 1, 2], [5.0, 5.0, 5.0])),
    (("apply_torques", 2, 5.0), ("apply_torques", [2], [5.0])),
    (("apply_torques", [2, 0], [1.0, 2.0]), ("apply_torques", [2, 0], [1.0, 2.0])),
    (("apply_torques", range(3), 5.0), ("apply_torques", [0, 1, 2], [5.0, 5.0, 5.0])),
    (("apply_currents", 2, 0.5), ("apply_currents", [2], [0.5])),
    (("apply_currents", [2, 1], 0.5), ("apply_currents", [2, 1], [0.5, 0.5])),
    (("apply_currents", range(3), 0.5), ("apply_currents", [0, 1, 2], [0.5, 0.5, 0.5])),
    (("apply_duty_cycles", 1, 1.5), ("apply_duty_cycles", [1], [1.5])),
    (("apply_duty_cycles", range(3), 1.5), ("apply_duty_cycles", [0, 1, 2], [1.5] * 3)),
    (("stop", 1), ("stop", [1])),
    (("stop", range(3)), ("stop", [0, 1, 2])),
    (("stop", [0, 1]), ("stop", [0, 1])),
    (("switch_control_modes", range(3), "vel"),
     ("switch_control_modes", [0, 1, 2], ["vel"] * 3)),
    (("preset_encoders", range(3), 0.0), ("preset_encoders", [0, 1, 2], [0.0] * 3)),
    (("preset_motor_encoders", 1, 4.0), ("preset_motor_encoders", [1], [4.0])),
    (("enable_amplifiers", 1), ("enable_amplifiers", [1])),
    (("disable_amplifiers", 0), ("disable_amplifiers", [0])),
    (("calibrate_joint", 1, 4, [1.0, 2.0, 3.0]),
     ("calibrate_joint", 1, 4, [1.0, 2.0, 3.0])),
    (("calibrate_joint", 1, 4, [1.0, 2.0, 3.0, 4.0]),
     ("calibrate_joint", 1, 4, [1.0, 2.0, 3.0, 4.0])),
    (("calibrate",), ("calibrate", [0, 1, 2])),
    (("home", 2), ("home", [2])),
    (("park",), ("park", [0, 1, 2])),
    (("quit_calibration",), ("quit_calibration",)),
    (("quit_parking",), ("quit_parking",)),
]  # fmt: skip


@pytest.mark.parametrize(("call", "heard"), COMMANDS, ids=lambda value: value[0])
def test_commands(network: CppYarp, device, board, call, heard):
    method, *arguments = call
    if network.version >= (4, 0) and call[-1] == [1.0, 2.0, 3.0, 4.0]:
        pytest.skip("YARP 4 has three parameters of a calibration")

    # A datagram may get lost, and udp is what C++ uses: it is sent until it is heard.
    def arrived():
        getattr(board, method)(*arguments)
        try:
            wait_until(lambda: device.done, 1.0)
        except AssertionError:
            return False
        return True

    wait_until(arrived, HANG, f"{call} arrived")
    assert device.done[0] == heard


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
    "impedances": ((-1.0, 1.0), (-2.0, 2.0), (-3.0, 3.0)),
    "impedance_offsets": (1.0, 2.0, 3.0),
}


@pytest.mark.parametrize("member", ADJUSTED)
def test_adjusting(device, board, member):
    values = ADJUSTED[member]
    assert getattr(board, member) != values
    setattr(board, member, [*values])
    assert getattr(board, member) == values
    assert [*getattr(device, member)] == [*values]


def test_ranges_and_targets(device, board):
    assert board.torque_ranges == ((-5.0, 5.0), (-6.0, 5.0), (-7.0, 5.0))
    assert board.current_ranges == ((-2.0, 2.0), (-2.0, 3.0), (-2.0, 4.0))
    assert board.impedance_ranges[0] == (0.0, 1.0, 0.0, 0.5)
    board.position_move(1, 5.0)
    assert board.position_targets()[1] == 5.0


def test_controllers(network: CppYarp, device, board):
    for kind in ("pos", "vel", "trq", "cur"):
        pids = board.pids[kind]
        assert pids.gains[0] == Gains(*map(float, range(1, 11)))
        pids.gains = [Gains(kp=2.0)] * 3
        pids.targets = (1.0, 2.0, 3.0)
        pids.error_limits = (1.0, 2.0, 3.0)
        pids.enabled = (True, False, True)
        pids.reset([2])
        assert [Gains(*gains).kp for gains in device.pids[kind].gains] == [2.0, 2.0, 2.0]
        assert [*device.pids[kind].targets] == [1.0, 2.0, 3.0]
        assert [*device.pids[kind].error_limits] == [1.0, 2.0, 3.0]
        assert [*device.pids[kind].enabled] == [True, False, True]
        assert device.pids[kind].was_reset == [2]
        assert pids.errors() == [0.5] * 3
        if network.version < (4, 0):  # whose server gives the targets instead
            assert pids.outputs() == [0.25] * 3


def test_variables(network: CppYarp, device, board):
    if network.version < (4, 0):  # whose client crashes with more than one
        assert [*board.variables] == ["gain", "limit"]
    assert board.variables["gain"] == [1.5, "low"]
    board.variables["gain"] = [2.5, "high"]
    assert device.variables["gain"] == [2.5, "high"]


def test_refusals_come_back(device, board):
    device.motion_done = None
    with pytest.raises(LocalProtocolError, match="refuses"):
        board.motion_done()

    def broken(joints, positions):
        raise OSError("no motor")

    device.position_move = broken
    with pytest.raises(LocalProtocolError, match="refuses"):
        board.position_move(0, 1.0)
    del device.motion_done, device.position_move


def test_the_same_questions_get_the_same_replies(network: CppYarp, device, board):
    """Asked of us and of C++ in front of us, word for word but for counters and times.

    (Not of `torq mtps`: those are four numbers in C++ 3.5, nine from 3.8 on.)
    """
    if network.version >= (4, 0):
        pytest.skip("YARP 4 asks in Thrift")
    questions = [
        "get axes", "get encs", "[get] [enc] 1", "get pos 1", "get poss", "get posg 2 (0 2)",
        "get vels", "get velg 2 (1 0)", "get acc 0", "get don 1", "get dons", "get dong 2 (0 1)",
        "get icmd cmod 1", "get icmd cmds", "get icmd cmog 2 (0 1)", "get icmd bogus",
        "get intm mode 0", "get intm mods", "get intm modg 2 (0 1)", "get llim 0", "get vlim 0",
        "get name 0", "get type 2", "get pid pid pos 0", "get pid pids vel", "get pid err trq 1",
        "get pid ena pos 0", "get pid lims cur", "get torq trq 0", "get torq trqs",
        "get torq rng 1", "get torq rngs", "get torq bogus", "get iimp ipr 0",
        "get iimp iof 0", "get iimp llim 0", "get icur ref 0", "get icur refs", "get icur rng 0",
        "get icur rngs", "get ipwm ref 0", "get ipwm refs", "get ipwm pwm 0", "get ipwm pwms",
        "get ivar lvar", "get ivar mvar gain", "get reca isca", "get prot", "set prot",
        "get mnum", "get mtnm", "get tmps", "get tmpl 0", "get gbxr 0", "get mcpr 1",
        "get maxc 0", "get acno 1", "get acpk 2", "get pwml 0", "get asta", "get acus",
        "get vmo 0", "get vmos", "get dpo 0", "get dpos", "get bogus", "bogus bogus", "bogus",
        "help", "set", "", "set poss (1 2)", "set posg 2 (0) (1 2)", "set vmo 0 1.0",
        "set icur ref 0 1.0", "set torq refs (1)", "cal", "cald 1", "help pid",
        "set pid pids pos ((1))", "set bogus 1",
    ]  # fmt: skip
    wait_until(lambda: board.encoders() == [0.0] * 3)
    wait_until(lambda: board.control_modes() == ["pos"] * 3)
    wait_until(lambda: board.interaction_modes() == ["stif"] * 3)
    with yarpy.RpcClient("/ours/rpc:i") as ours, yarpy.RpcClient("/cpp/rpc:i") as theirs:
        for text in questions:
            for question in (Bottle.from_text(text), vocabs(Bottle.from_text(text))):
                mine = timeless(ours.ask(question, HANG).as_(Bottle))
                assert (text, mine) == (text, timeless(theirs.ask(question, HANG).as_(Bottle)))


def vocabs(question):
    return Bottle(Vocab(e) if type(e) is str and len(e) <= 4 else e for e in question)


def timeless(reply):
    """A reply as text, without the count and time of [tsta]."""
    if "tsta" in reply:
        at = reply.index("tsta")
        assert type(reply[at + 1]) is int and type(reply[at + 2]) is float
        reply[at + 1 : at + 3] = []
    return reply.to_text()
