"""Servos on a bus as a control board, with servos that are not there."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

if sys.platform == "win32":
    pytest.skip("there are no pseudo terminals", allow_module_level=True)

from support.servo_bus import ServoBus
from support.wait import HANG, wait_until

from yarpy import Property, Timeout
from yarpy.kits.devices import ControlBoard, ControlBoardServer
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware import servo
from yarpy.kits.devices.hardware.servo import (
    DYNAMIXEL,
    FEETECH,
    Kind,
    Register,
    ServoBoard,
    dynamixel,
    feetech,
)
from yarpy.nameserver.local import LocalNames

SERVOS = servo.TIMEOUT  # seconds


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """The servos are a thread of this program, which may have to wait longer for its turn than a
    servo takes to answer."""
    monkeypatch.setattr(servo, "TIMEOUT", HANG)
    return monkeypatch


@pytest.fixture(params=[(FEETECH, 1), (DYNAMIXEL, 2)], ids=["feetech", "dynamixel"])
def both(request: pytest.FixtureRequest) -> Iterator[tuple[Kind, ServoBus, ServoBoard]]:
    kind, version = request.param
    with ServoBus(version, [1, 2, 5]) as bus:
        for number in bus.servos:
            bus.put(number, kind.position.at, kind.position.size, 2048)
            bus.put(number, kind.torque.at, 1, 1)
        with ServoBoard(kind, bus.port, [5, 1], ["lift", "pan"]) as board:
            yield kind, bus, board


@contextmanager
def impatient() -> Iterator[None]:
    """The time limit is that of servos, here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(servo, "TIMEOUT", SERVOS)
        yield


class NoisyLine(Closeable):
    """Something always comes over it, and never an answer."""

    def __init__(self, path: str, speed: int) -> None:
        self.path, self._resources = path, ExitStack()

    def write(self, data: bytes) -> None:
        pass

    def discard(self) -> None:
        pass

    def read(self, until: float) -> bytes:
        return b"\x00"


def test_a_line_that_is_never_silent_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(servo, "Line", NoisyLine)
    monkeypatch.setattr(servo, "NOISE", 0.01)
    with impatient(), pytest.raises(Timeout, match="servo 1 does not answer"):
        ServoBoard(FEETECH, "/dev/noise", [1])


def test_they_begin_limp(both: tuple[Kind, ServoBus, ServoBoard]) -> None:
    kind, bus, board = both
    assert board.control_modes() == ["idl", "idl"]
    wait_until(lambda: not bus.number(1, kind.torque.at, 1))
    assert not bus.number(5, kind.torque.at, 1)
    assert bus.number(2, kind.torque.at, 1), "it was not asked for"


def test_measurements(both: tuple[Kind, ServoBus, ServoBoard]) -> None:
    kind, bus, board = both
    bus.put(5, kind.position.at, kind.position.size, 3072)
    bus.put(1, kind.temperature.at, 1, 41)
    bus.put(5, kind.moving.at, 1, 1)
    assert board.encoders() == [90.0, 0.0]
    assert board.motor_temperatures() == [0.0, 41.0]
    assert board.motion_done() == [False, True]
    back = kind.speed.write(-100)
    bus.servos[1][kind.speed.at : kind.speed.at + len(back)] = back
    assert board.encoder_speeds() == [0.0, -100 * kind.unit]


def test_moving(both: tuple[Kind, ServoBus, ServoBoard]) -> None:
    kind, bus, board = both
    goal, pace = kind.goal, kind.pace
    bus.put(1, kind.position.at, kind.position.size, 1000)
    board.switch_control_modes([1], ["posd"])
    wait_until(lambda: bus.number(1, kind.torque.at, 1))
    assert bus.number(1, goal.at, goal.size) == 1000, "it stays where it is"
    assert board.control_modes() == ["idl", "pos"]
    board.reference_speeds = [30.0, 90.0]
    board.position_move([0, 1], [90.0, -500.0])
    wait_until(lambda: bus.number(5, goal.at, goal.size) == 3072)
    assert bus.number(1, goal.at, goal.size) == 0, "no further than it goes"
    assert bus.number(1, pace.at, pace.size) == round(90.0 / kind.unit)
    board.position_direct([1], [180.0])
    wait_until(lambda: bus.number(1, goal.at, goal.size) == 4095)
    assert bus.number(1, pace.at, pace.size) == 0
    board.stop([1])
    wait_until(lambda: bus.number(1, goal.at, goal.size) == 1000)
    with pytest.raises(ValueError, match="the modes pos and idl"):
        board.switch_control_modes([0], ["torq"])


def test_a_servo_that_is_unplugged(both: tuple[Kind, ServoBus, ServoBoard]) -> None:
    _, bus, board = both
    gone = bus.servos.pop(1)
    with impatient(), pytest.raises(Timeout, match=r"servo \d does not answer"):
        board.encoders()
    bus.servos[1] = gone
    assert board.encoders() == [0.0, 0.0]


def test_a_late_answer_answers_nothing_else(both: tuple[Kind, ServoBus, ServoBoard]) -> None:
    """It does not say which register it is about, and speeds are as long as positions."""
    _, bus, board = both
    bus.late = []
    with impatient(), pytest.raises(Timeout, match="does not answer"):
        board.encoders()
    wait_until(lambda: len(bus.late or ()) == 2)
    bus.catch_up()
    assert board.encoder_speeds() == [0.0, 0.0]


def test_on_ports(both: tuple[Kind, ServoBus, ServoBoard], names: LocalNames) -> None:
    kind, bus, board = both
    with (
        ControlBoardServer("/arm", board, names=names),
        ControlBoard("/arm", timeout=HANG, names=names) as arm,
    ):
        assert [*arm.axis_names] == ["lift", "pan"]
        arm.switch_control_modes("pan", "pos")
        arm.position_move("pan", 90.0)
        wait_until(lambda: bus.number(1, kind.goal.at, kind.goal.size) == 3072)
        bus.put(1, kind.position.at, kind.position.size, 3072)
        wait_until(lambda: arm.encoders() == [0.0, 90.0])


def test_registers() -> None:
    signed, plain = Register(58, 2, 15), Register(128, 4)
    for number in (0, 1, 300, -1, -300):
        assert signed.read(signed.write(number)) == number
        assert plain.read(plain.write(number)) == number
    assert signed.write(-5) == b"\x05\x80" and plain.write(-5) == b"\xfb\xff\xff\xff"


@pytest.mark.parametrize(("make", "version"), [(feetech, 1), (dynamixel, 2)])
def test_in_the_file_of_a_robot(make: object, version: int) -> None:
    assert callable(make)
    with ServoBus(version, [3, 4]) as bus:
        options = Property.from_text(f"(port {bus.port}) (ids (3 4)) (AxisName (a b))")
        board = make(options)
        assert board.axis_names == ["a", "b"]
        board.close()
        with impatient(), pytest.raises(Timeout, match=r"servo [39]"):
            make(Property.from_text(f"(port {bus.port}) (ids (3 9))"))


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("(ids (1))", "needs the parameters port"),
        ("(port /dev/null) (ids (one))", "ids, a list of numbers"),
        ("(port /dev/null) (ids (1 1))", "different numbers"),
        ("(port /dev/null) (ids (1 300))", "different numbers"),
        ("(port /dev/null) (ids (1 2)) (AxisName (a))", "1 names for 2 servos"),
        ("(port /dev/null) (ids (1)) (baud fast)", "baud fast is no number"),
    ],
)
def test_parameters_that_are_wrong(options: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        feetech(Property.from_text(options))
