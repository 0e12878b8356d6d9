import logging
import threading
import time

import pytest
from support.board import Bare, FakeBoard

from yarpy.devices.control_board.access import Board
from yarpy.devices.kind import JOINT_TYPE, PAIR
from yarpy.devices.refusal import Refused
from yarpy.errors import LocalProtocolError


def board(device):
    return Board(device, "/head")


def test_measurements_and_attributes():
    it = board(FakeBoard())
    assert it.count == 3
    assert it.values("encoders") == [0.0, 0.0, 0.0]
    assert it.values("position_limits", PAIR)[1] == (-31.0, 30.0)
    assert it.timestamps() == [0.0, 0.0, 0.0]
    assert it.values("axis_types", JOINT_TYPE) == ["revolute", "revolute", "prismatic"]


def test_the_least():
    it = board(Bare())
    assert it.values("encoders") == [1.5, -2.0]
    assert it.values("axis_types", JOINT_TYPE) == ["revolute", "revolute"]
    assert abs(it.timestamps()[0] - time.time()) < 60
    for member in ("torques", "reference_speeds", "position_targets"):
        with pytest.raises(Refused, match=f"has no {member}"):
            it.values(member)
    with pytest.raises(Refused, match="has no position_move"):
        it.apply("position_move", [0], [1.0])
    with pytest.raises(Refused, match="has no pids"):
        it.pid("pos")


@pytest.mark.parametrize("names", [[], "", "head", None])
def test_a_board_has_joints(names):
    class Empty(Bare):
        axis_names = names

    with pytest.raises(ValueError, match="axis_names"):
        board(Empty())


def test_a_device_without_names():
    with pytest.raises(ValueError, match="axis_names"):
        board(object())


def test_attributes_are_assigned_whole():
    seen = []

    class Limited(Bare):
        peaks = (4.0, 4.0)

        @property
        def peak_currents(self):
            return self.peaks

        @peak_currents.setter
        def peak_currents(self, values):
            seen.append(values)

        @property
        def gearbox_ratios(self):
            return [1.0, 1.0]

    it = board(Limited())
    it.apply("peak_currents", [1], [5.0])
    assert seen == [[4.0, 5.0]]
    with pytest.raises(Refused, match="gearbox_ratios failed"):
        it.apply("gearbox_ratios", [0], [3.0])
    with pytest.raises(Refused, match="needs values"):
        it.apply("peak_currents", [0], None)


@pytest.mark.parametrize("joints", [[], [-1], [3], [0, 3]])
def test_joints_that_are_not_there(joints):
    device = FakeBoard()
    with pytest.raises(Refused):
        board(device).apply("position_move", joints, [1.0] * len(joints))
    assert device.done == []


@pytest.mark.parametrize("given", [[1.0], [1.0, 2.0, 3.0], None, ["x", "y"], 5, [None, 1.0]])
def test_what_is_not_as_promised_is_refused(given, caplog):
    class Wrong(Bare):
        def torques(self):
            return given

    with caplog.at_level(logging.WARNING), pytest.raises(Refused, match="torques failed"):
        board(Wrong()).values("torques")
    assert len(caplog.records) == 1 and "/head: torques:" in caplog.text


def test_what_a_device_raises_is_logged_in_one_line(caplog):
    class Broken(Bare):
        def position_move(self, joints, positions):
            raise OSError("no motor")

        def torques(self):
            raise NotImplementedError

        def currents(self):
            raise LocalProtocolError("the remote one has none")

    it = board(Broken())
    with caplog.at_level(logging.INFO):
        with pytest.raises(Refused):
            it.apply("position_move", [0], [1.0])
        for quiet in ("torques", "currents"):
            with pytest.raises(Refused, match="has no"):
                it.values(quiet)
    assert [record.getMessage() for record in caplog.records] == [
        "/head: position_move: OSError: no motor"
    ]


def test_commands_are_remembered():
    device = FakeBoard()
    device.where = [1.0, 2.0, 3.0]
    it = board(device)
    assert it.values("position_targets") == [1.0, 2.0, 3.0]
    assert it.values("velocity_targets") == [0.0, 0.0, 0.0]
    it.apply("position_move", [1], [9.0])
    it.apply("velocity_move", [0, 2], [4.0, 5.0])
    assert it.values("position_targets") == [1.0, 9.0, 3.0]
    assert it.values("velocity_targets") == [4.0, 0.0, 5.0]
    it.apply("stop", [2], None)
    assert it.values("velocity_targets") == [4.0, 0.0, 0.0]
    it.apply("relative_move", [1, 2], [-1.0, 1.0])
    assert device.done[-1] == ("position_move", [1, 2], [8.0, 4.0])


def test_targets_of_the_device_itself_count():
    class Knowing(FakeBoard):
        def position_targets(self):
            return [7.0] * self.count

        def relative_move(self, joints, distances):
            self.note("relative_move", joints, distances)

    device = Knowing()
    it = board(device)
    it.apply("relative_move", [0], [2.0])
    assert device.done == [("relative_move", [0], [2.0])]
    assert it.values("position_targets") == [7.0, 7.0, 7.0]


def test_relative_move_of_the_device_is_remembered_too():
    class Moving(FakeBoard):
        def relative_move(self, joints, distances):
            self.note("relative_move", joints, distances)

    it = board(Moving())
    it.apply("relative_move", [2], [2.0])
    assert it.values("position_targets") == [0.0, 0.0, 2.0]
    with pytest.raises(Refused):
        it.apply("relative_move", [5], [2.0])


def test_one_thread_at_a_time_but_for_what_takes_long():
    entered, leave = threading.Event(), threading.Event()

    class Slow(Bare):
        def park(self, joints):
            entered.set()
            assert leave.wait(20)

    it = board(Slow())
    thread = threading.Thread(target=it.apply, args=("park", [0], None), daemon=True)
    thread.start()
    assert entered.wait(20)
    assert it.values("encoders") == [1.5, -2.0]  # while it parks
    leave.set()
    thread.join(20)

    inside, most = [0], [0]

    class Counting(Bare):
        def encoders(self):
            inside[0] += 1
            most[0] = max(most[0], inside[0])
            time.sleep(0.001)
            inside[0] -= 1
            return (0.0, 0.0)

    it = board(Counting())
    threads = [
        threading.Thread(target=lambda: [it.values("encoders") for _ in range(10)])
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    assert most == [1]


def test_controllers():
    device = FakeBoard()
    pids = board(device).pid("vel")
    assert pids.values("targets") == [0.0, 0.0, 0.0]
    pids.apply("targets", [1], [3.0])
    pids.apply("reset", [2], None)
    assert device.pids["vel"].targets == [0.0, 3.0, 0.0]
    assert device.pids["vel"].was_reset == [2]
    with pytest.raises(Refused, match="no bogu controllers"):
        board(device).pid("bogu")


def test_a_device_without_encoders():
    class Blind:
        axis_names = ("left",)

    with pytest.raises(ValueError, match="encoders"):
        board(Blind())
