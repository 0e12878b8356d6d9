"""A user's object, whatever it does, used without harm to its server or its callers."""

import logging
import threading
import time

import pytest
from support.board import Bare, FakeBoard
from support.wait import HANG

from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused


def access(device):
    return Access(device, len(device.axis_names), DeviceErrorLog("/head"), threading.Lock())


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

    it = access(Limited())
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
        access(device).apply("position_move", joints, [1.0] * len(joints))
    assert device.done == []


@pytest.mark.parametrize("given", [[1.0], [1.0, 2.0, 3.0], None, ["x", "y"], 5, [None, 1.0]])
def test_what_is_not_as_promised_is_refused(given, caplog):
    class Wrong(Bare):
        def torques(self):
            return given

    with caplog.at_level(logging.WARNING), pytest.raises(Refused, match="torques failed"):
        access(Wrong()).values("torques")
    assert len(caplog.records) == 1 and "/head: torques:" in caplog.text


def test_what_a_device_raises_is_logged_in_one_line(caplog):
    class Broken(Bare):
        def position_move(self, joints, positions):
            raise OSError("no motor")

        def torques(self):
            raise NotImplementedError

        def currents(self):
            raise LocalProtocolError("the remote one has none")

    it = access(Broken())
    with caplog.at_level(logging.INFO):
        with pytest.raises(Refused):
            it.apply("position_move", [0], [1.0])
        for quiet in ("torques", "currents"):
            with pytest.raises(Refused, match="has no"):
                it.values(quiet)
    assert [record.getMessage() for record in caplog.records] == [
        "/head: position_move: OSError: no motor"
    ]


def test_one_thread_at_a_time_but_for_what_takes_long():
    entered, leave = threading.Event(), threading.Event()

    class Slow(Bare):
        def park(self, joints):
            entered.set()
            assert leave.wait(HANG)

    it = access(Slow())
    thread = threading.Thread(target=it.apply, args=("park", [0], None), daemon=True)
    thread.start()
    assert entered.wait(HANG)
    assert it.values("encoders") == [1.5, -2.0]  # while it parks
    leave.set()
    thread.join(HANG)

    inside, most = [0], [0]

    class Counting(Bare):
        def encoders(self):
            inside[0] += 1
            most[0] = max(most[0], inside[0])
            time.sleep(0.001)
            inside[0] -= 1
            return (0.0, 0.0)

    it = access(Counting())
    threads = [
        threading.Thread(target=lambda: [it.values("encoders") for _ in range(10)])
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANG)
    assert most == [1]
