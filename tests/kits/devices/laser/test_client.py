"""A remote laser: of C++ 4.0.0 as recorded, of older ones, of yarpy; and behind another."""

import pytest
from kits.devices.laser.test_server import Scanner
from support.wait import HANG
from support.yarp4 import replay_device

import yarpy
from yarpy import Bottle
from yarpy.errors import DecodeError, LocalProtocolError, UnknownName
from yarpy.kits.devices.laser.client import Laser
from yarpy.kits.devices.laser.server import LaserServer


def test_of_yarpy(names):
    device = Scanner()
    with (
        LaserServer("/laser", device, 0.01, names=names),
        Laser("/laser", names=names, timeout=HANG) as near,
        LaserServer("/relay", near, 0.01, names=names),
        Laser("/relay", names=names, timeout=HANG) as laser,
    ):
        scan = laser.scan()
        assert scan.angles == (-90.5, 90.5) and scan.distances == (0.25, 8.5)
        assert scan.ranges.tolist() == [1.5, float("inf"), 3.5]
        assert scan.condition == laser.condition() == "in use" and scan.time > 1e9
        assert (laser.angles, laser.distances) == ((-90.5, 90.5), (0.25, 8.5))
        assert (laser.step, laser.rate, laser.info) == (1.5, 10.5, "a scanner")
        laser.distances, laser.angles, laser.step, laser.rate = (0.5, 1.5), (1, 2), 3, 4
        assert (device.distances, device.angles) == ((0.5, 1.5), (1.0, 2.0))
        assert (device.step, device.rate) == (3.0, 4.0)
        with pytest.raises(LocalProtocolError, match="refuses rate"):
            laser.rate = float("nan")


def test_of_cpp_4(names):
    with (
        replay_device("laser", "/laser/rpc:i", "/laser", names),
        Laser("/laser", names=names, timeout=HANG) as laser,
    ):
        scan = laser.scan()
        assert len(scan.ranges) == 12 and scan.distances[1] == 8.0
        assert laser.info == "Fake Laser device for test/debugging"
        assert laser.step == 30.0 and laser.rate == 0.02
        assert laser.distances == (0.1, 8.0) and laser.angles == (0.0, 360.0)
        laser.distances = 0.5, 4.5


def test_of_older_cpp(names):
    answers = {
        "[get] [ilas] [lsdr]": "[is] [lsdr] 0.1 8.0",
        "[get] [ilas] [lsnf]": '[is] [lsnf] "an old one"',
        "[set] [ilas] [lssr] 5.0": "[ok]",
        "getScanLimits [RPC]": "[ok] 0.0 90.0",  # of 3.10
    }

    def answer(message):
        return Bottle.from_text(answers.get(message.as_(Bottle).to_text(), "[fail]"))

    with (
        yarpy.RpcServer("/laser/rpc:i", answer, names=names),
        yarpy.BufferedPort("/laser", names=names) as source,
        Laser("/laser", names=names, timeout=HANG) as laser,
    ):
        assert laser.distances == (0.1, 8.0) and laser.info == "an old one"
        assert laser.angles == (0.0, 90.0)
        laser.rate = 5
        with pytest.raises(LocalProtocolError, match="refuses step"):
            laser.step = 1
        source.write([0.0, 360.0, 0.1, 8.0, [1.5, 1.5], 9], wait=True)
        assert laser.condition() == "error" and laser.ranges().tolist() == [1.5, 1.5]
        source.write(["nonsense"], wait=True)
        with pytest.raises(DecodeError):
            laser.scan()


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        Laser("/nobody", names=names)
