import pytest
from support.board import Bare, FakeBoard
from support.capture import load_capture
from support.replay import messages_of
from support.yarp4 import recorded

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.control_board.board import Board
from yarpy.kits.devices.control_board.state import FIELDS, NEWER, State


def state_of(device):
    board = Board(device, "/head")
    return State.of(board.count, board.values)


def test_bytes_are_those_of_cpp():
    """The recorded board stood at 5 degrees, with interaction modes that were no words."""
    _, messages = messages_of(load_capture("mc_stateExt_o"))
    device = FakeBoard(3)
    device.where = [5.0, 0.0, 0.0]
    ours = Bottle.from_bytes(state_of(device).to_bytes())
    assert ours[-2] == [Vocab("stif").code] * 3
    ours[-2] = Bottle([0, 0, 0])
    assert ours.to_bytes() == bytes(messages[0].payload)
    assert messages[0].stamp == Stamp(425, 0.0)


def test_reading_what_cpp_sends():
    _, messages = messages_of(load_capture("mc_stateExt_o"))
    state = State.from_bottle(messages[0].as_(Bottle))
    assert state.count == 3
    assert state.values["encoders"] == [5.0, 0.0, 0.0]
    assert state.values["currents"] == [3300.0, 3400.0, 3500.0]
    assert state.values["control_modes"] == ["pos", "pos", "pos"]
    assert list(state.values) == [name for name, _ in FIELDS]


def test_bytes_of_yarp_4():
    data = bytes.fromhex(recorded("board")["state"])
    state = State.from_bottle(codec.decode_as(data, Bottle))
    assert [name for name, _ in NEWER] == [*state.values]
    assert state.values["encoders"] == [5.5, 6.5, 7.5]
    assert state.values["motor_temperatures"] == [37.5, 38.5, 39.5]
    assert state.values["duty_cycles"] == [33.0, 34.0, 35.0]
    ours = Bottle.from_bytes(state.to_bytes(newer=True))
    ours[20] = Bottle([0, Vocab("comp").code, 0])  # two of its modes were no words
    assert to_yarp4(ours.to_bytes()) == data
    assert len(Bottle.from_bytes(state_of(Bare()).to_bytes(newer=True))) == 24


def test_what_is_missing_has_its_place():
    state = state_of(Bare())
    message = Bottle.from_bytes(state.to_bytes())
    assert len(message) == 22
    assert message[:4] == [[1.5, -2.0], "ok", [0.0, 0.0], "fail"]
    assert message[18:] == [[Vocab("unkw").code] * 2, "fail"] * 2
    # Lists of floats and of int32 as such, whatever is in them: C++ takes no others.
    data = message.to_bytes()
    assert data.count(bytes.fromhex("0a01000002000000")) == 9
    assert data.count(bytes.fromhex("0101000002000000")) == 2
    again = State.from_bottle(Bottle.from_bytes(data))
    assert again.values == {"encoders": [1.5, -2.0]} and again.count == 2


@pytest.mark.parametrize("flag", [0, Vocab("fail"), False])
def test_flags_that_mean_no(flag):
    message = Bottle.from_bytes(state_of(FakeBoard()).to_bytes())
    message[1] = flag
    assert "encoders" not in State.from_bottle(message).values


@pytest.mark.parametrize("flag", [1, Vocab("ok"), True, 5])
def test_flags_that_mean_yes(flag):
    message = Bottle.from_bytes(state_of(FakeBoard()).to_bytes())
    message[1] = flag
    assert "encoders" in State.from_bottle(message).values


@pytest.mark.parametrize(
    ("index", "value"),
    [(0, []), (0, 5), (2, [1.0]), (4, ["a", "b", "c"]), (18, ["x", "y", "z"]), (20, [1.5] * 3)],
)
def test_no_states(index, value):
    message = Bottle.from_bytes(state_of(FakeBoard()).to_bytes())
    message[index] = value
    with pytest.raises(DecodeError):
        State.from_bottle(message)


def test_states_of_another_length():
    message = Bottle.from_bytes(state_of(FakeBoard()).to_bytes())
    for wrong in ([], message[:-1], [*message, 1]):
        with pytest.raises(DecodeError, match="22"):
            State.from_bottle(wrong)
