import math

import pytest
from support.yarp4 import recorded

from yarpy.data.bottle import Bottle
from yarpy.data.value import Float32, Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.kits.devices.control_board.command import HEADS, make, read
from yarpy.kits.devices.control_board.grammar import Form
from yarpy.kits.devices.refusal import Refused


def heard(text, count=4):
    return read(Bottle.from_text(text), count)


# Text of what remote_controlboard sends -> what it means
SENT = {
    "([vmo] 1) (8.0)": ("velocity_move", [1], [8.0]),
    "([vmos]) (1.0 2.0 3.0 4.0)": ("velocity_move", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
    "([vmog] 2 (0 2)) (1.0 2.0)": ("velocity_move", [0, 2], [1.0, 2.0]),
    "([ived] [vdso] 1) (8.0)": ("velocity_direct", [1], [8.0]),
    "([ived] [vdsa]) (1.0 2.0 3.0 4.0)": ("velocity_direct", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
    "([ived] [vdsg] 2 (0 2)) (1.0 2.0)": ("velocity_direct", [0, 2], [1.0, 2.0]),
    "([dpo] 3) (-8.5)": ("position_direct", [3], [-8.5]),
    "([dpos]) (1.0 2.0 3.0 4.0)": ("position_direct", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
    "([dpog] 3 (2 1 0)) (1.0 2.0 3.0)": ("position_direct", [2, 1, 0], [1.0, 2.0, 3.0]),
    "([dtq] 0) (0.5)": ("apply_torques", [0], [0.5]),
    "([dtqs]) (1.0 2.0 3.0 4.0)": ("apply_torques", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
    "([dtqg] 2 (0 2)) (1.0 2.0)": ("apply_torques", [0, 2], [1.0, 2.0]),
    "([icur] [ref] 1) (0.25)": ("apply_currents", [1], [0.25]),
    "([icur] [refs]) (1.0 2.0 3.0 4.0)": ("apply_currents", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
    "([icur] [refg] 2 (0 2)) (1.0 2.0)": ("apply_currents", [0, 2], [1.0, 2.0]),
    "([ipwm] [ref] 1) (50.0)": ("apply_duty_cycles", [1], [50.0]),
    "([ipwm] [refs]) (1.0 2.0 3.0 4.0)": ("apply_duty_cycles", [*range(4)], [1.0, 2.0, 3.0, 4.0]),
    "([poss]) (1.0 2.0 3.0 4.0)": ("position_move", [0, 1, 2, 3], [1.0, 2.0, 3.0, 4.0]),
}


@pytest.mark.parametrize("text", SENT)
def test_commands(text):
    assert heard(text) == SENT[text]


def test_every_head_is_tested():
    words = {tuple(e for e in Bottle.from_text(text)[0] if isinstance(e, Vocab)) for text in SENT}
    assert words == set(HEADS)


def test_bytes():
    """Spec: the head's own list, then the vector, in a list of two."""
    [message] = make("velocity_move", [2], [10.5], 4)
    assert message.to_bytes().hex(" ") == (
        "00 01 00 00 02 00 00 00 "
        "00 01 00 00 02 00 00 00 09 00 00 00 76 6d 6f 00 01 00 00 00 02 00 00 00 "
        "0a 01 00 00 01 00 00 00 00 00 00 00 00 00 25 40"
    )
    [message] = make("position_direct", [0, 1], [1.0, 2.0], 2)
    assert message.to_bytes()[8:24].hex(" ") == "09 01 00 00 01 00 00 00 64 70 6f 73 0a 01 00 00"


@pytest.mark.parametrize(
    "method", sorted({method for method, _ in HEADS.values()} - {"position_move"})
)
@pytest.mark.parametrize("joints", [[0], [3], [0, 1, 2, 3], [2, 0]])
def test_what_is_made_is_read(method, joints):
    values = [1.5 + joint for joint in joints]
    messages = make(method, joints, values, 4)
    found = [read(Bottle.from_bytes(message.to_bytes()), 4) for message in messages]
    assert {name for name, _, _ in found} == {method}
    assert [joint for _, js, _ in found for joint in js] == joints
    assert [value for _, _, vs in found for value in vs] == values
    in_groups = any(row == (method, Form.SOME) for row in HEADS.values())
    assert len(messages) == (1 if len(joints) in (1, 4) or in_groups else len(joints))


def test_words_of_yarp_4():
    """As controlBoard_nwc_yarp sends them: with the word of an interface in front."""
    assert heard("([ivel] [vmo] 1) (8.0)") == ("velocity_move", [1], [8.0])
    assert heard("([ipod] [dpog] 2 (2 1)) (8.0 9.0)") == ("position_direct", [2, 1], [8.0, 9.0])
    assert heard("([itrq] [dtqs]) (1.0 2.0)", 2) == ("apply_torques", [0, 1], [1.0, 2.0])
    assert heard("([ipos] [poss]) (1.0 2.0)", 2) == ("position_move", [0, 1], [1.0, 2.0])
    sent = [bytes.fromhex(r["message"]) for r in recorded("board")["client"] if "message" in r]
    calls = (("velocity_move", 0, 5.5), ("position_direct", 1, 3.25), ("apply_torques", 0, 1.5))
    for data, (method, joint, value) in zip(sent, calls, strict=True):
        [message] = make(method, [joint], [value], 3, newer=True)
        assert to_yarp4(message.to_bytes()) == data
    [message] = make("velocity_direct", [0, 2], [1.0, 2.0], 3, newer=True)
    assert message == [["ived", "vdsg", 2, [0, 2]], [1.0, 2.0]]
    [message] = make("apply_currents", [0, 1], [1.0, 2.0], 2, newer=True)
    assert message[0] == ["icur", "refs"]


def test_one_joint_is_one_joint():
    [message] = make("velocity_move", [0], [1.0], 1)
    assert message == [["vmo", 0], [1.0]]


@pytest.mark.parametrize(
    "text",
    [
        "", "5", "([vmo] 1)", "([vmo] 1) (8.0) 1", "[vmo] (8.0)", "([vmo]) (8.0)", "() (8.0)",
        "([bogus] 1) (8.0)", "([icur] 1) (8.0)", "([icur]) (8.0)", "([icur] [bad] 1) (8.0)",
        "([posd]) (1.0 2.0 3.0 4.0)", "([veld]) (1.0 2.0 3.0 4.0)",  # modes are set by rpc
        "([vmo] 1) (8)", "([vmos]) (1 2 3 9)", "([vmos]) (1.0 2.0 3.0 9)",  # not float64
        "([vmo] 1) ()", "([vmo] 1) (1.0 2.0)", "([vmos]) (1.0 2.0 3.0)",
        "([vmos]) (1.0 2.0 3.0 4.0 5.0)", "([vmog] 2 (0)) (1.0 2.0)", "([vmog] 2 (0 2)) (1.0)",
        "([vmog] 2) (1.0 2.0)", "([vmog] x (0 2)) (1.0 2.0)", "([vmo] x) (8.0)",
        "([vmo] 1.5) (8.0)", "([vmog] -1 ()) (8.0)", "([vmo] 1) (inf)", "([vmo] 1) (nan)",
        "([dpo] 1) (x)",
    ],
)  # fmt: skip
def test_no_commands(text):
    with pytest.raises(Refused):
        heard(text)


@pytest.mark.parametrize("value", [math.nan, math.inf, Float32(1.0), 1, True, "1.0", None])
def test_values_are_finite_float64(value):
    with pytest.raises(Refused):
        read([["vmo", 0], [value]], 2)


def test_people_may_type_whole_numbers():
    assert read([["vmo", 0], [8]], 2, exact=False) == ("velocity_move", [0], [8.0])
    with pytest.raises(Refused):
        read([["vmo", 0], ["8"]], 2, exact=False)
