"""Functions and members: every row is a function, and every shape gives back what it was given."""

import pytest

from yarpy.kits.devices.control_board.grammar import Form
from yarpy.kits.devices.control_board.interface import ControlBoardLike, Gains, PidController
from yarpy.kits.devices.control_board.yarp4 import table
from yarpy.kits.devices.control_board.yarp4.functions import ControlBoardMsgs, Pid
from yarpy.kits.devices.refusal import Refused

NAMES = {name.removesuffix("RPC") for name in ControlBoardMsgs._methods}


@pytest.mark.parametrize("rows", [table.READ, table.WRITE, table.PID_READ, table.PID_WRITE])
def test_rows_are_functions_and_members(rows: tuple[table.Row, ...]) -> None:
    owner = PidController if rows in (table.PID_READ, table.PID_WRITE) else ControlBoardLike
    members = {*dir(owner), *owner.__annotations__, *dir(ControlBoardLike)}
    members |= {"axis_types", "axis_names"}
    for row in rows:
        assert row.words().keys() <= NAMES, row
        assert row.member in members, row


def test_what_has_a_form_of_its_own() -> None:
    assert {*table.CALIBRATOR, *table.QUITTING} <= NAMES
    assert {form for _, form in table.CALIBRATOR.values()} == {Form.ONE, Form.ALL}
    for members in table.INTERFACES.values():
        for member in members:
            assert hasattr(ControlBoardLike, member) or member in (
                *("axis_names", "pids", "variables"),
                *ControlBoardLike.__annotations__,
            )


@pytest.mark.parametrize(
    ("shape", "value", "fields"),
    [
        (table.VALUE, 1.5, [1.5]), (table.INTEGER, 3, [3]), (table.TRUTH, True, [True]),
        (table.NAME, "neck", ["neck"]), (table.MODE, "vel", [7103862]),
        (table.JOINT, "revolute", [1987212385]), (table.JOINT, "prismatic", [1919972449]),
        (table.RANGE, (1.0, 2.0), [1.0, 2.0]), (table.FAULTS, (7, "hot"), [7, "hot"]),
        (table.STIFFNESS_RANGE, (1.0, 2.0, 3.0, 4.0), [1.0, 2.0, 3.0, 4.0]),
    ],
)  # fmt: skip
def test_shapes(shape: table.Shape, value: object, fields: list[object]) -> None:
    assert shape.spread(value) == fields and shape.gather(fields) == value


def test_gains_have_another_order_in_yarp_4() -> None:
    gains = Gains(*map(float, range(10)))
    (pid,) = table.GAINS_.spread(gains)
    assert isinstance(pid, Pid)
    assert (pid.kp, pid.max_integral, pid.scale, pid.max_output, pid.offset) == (0, 3, 6, 4, 5)
    assert list(pid.to_bottle())[3:7] == [3.0, 6.0, 4.0, 5.0]
    assert table.GAINS_.gather([pid]) == gains
    model = tuple(map(float, range(9)))
    assert table.TORQUE.gather(table.TORQUE.spread(model)) == model


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_numbers_are_finite(bad: float) -> None:
    for shape, fields in (
        (table.VALUE, [bad]), (table.RANGE, [1.0, bad]), (table.GAINS_, [Pid(kd=bad)]),
    ):  # fmt: skip
        with pytest.raises(Refused):
            shape.gather(fields)


def test_what_is_said_of_controllers_is_texts_by_name() -> None:
    said = table.DETAILS.kind.check({"kp": "V/deg"})
    (sent,) = table.DETAILS.spread(said)
    found = table.DETAILS.gather([sent])
    assert found["kp"] == "V/deg" and found["ki"] == "" and len(found) == 13
    with pytest.raises(ValueError, match="not colour"):
        table.DETAILS.kind.check({"colour": "red"})
