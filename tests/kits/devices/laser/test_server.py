"""A laser on ports: scans, and what programs of several versions ask."""

import logging

import pytest
from support.wait import HANG

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.kits.devices.laser.functions import IRangefinder2DMsgs, LaserScan2D
from yarpy.kits.devices.laser.server import LaserServer
from yarpy.kits.thrift.client import client_class


class Scanner:
    angles = (-90.5, 90.5)
    distances = (0.25, 8.5)
    step = 1.5
    rate = 10.5
    info = "a scanner"

    def ranges(self):
        return [1.5, float("inf"), 3.5]


@pytest.fixture
def device():
    return Scanner()


@pytest.fixture
def server(device, names):
    with LaserServer("/laser", device, 0.01, names=names) as server:
        yield server


@pytest.fixture
def client(server, names):
    with yarpy.RpcClient("/laser/rpc:i", name="/me/rpc:o", names=names) as client:
        yield client


def test_scans(server, names):
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/laser")
        message = port.read(HANG)
    scan = message.as_(LaserScan2D)
    assert (scan.angle_min, scan.angle_max, scan.range_min, scan.range_max) == (
        -90.5,
        90.5,
        0.25,
        8.5,
    )
    assert scan.scans.tolist() == [1.5, float("inf"), 3.5] and scan.status == 1
    assert message.value[4] == [1.5, float("inf"), 3.5] and message.stamp.time > 1e9


@pytest.mark.parametrize(
    ("asked", "answer"),
    [
        ("[get] [ilas] [lsdr]", "[is] [lsdr] 0.25 8.5"),
        ("[get] [ilas] [lsar]", "[is] [lsar] -90.5 90.5"),
        ("[get] [ilas] [lsas]", "[is] [lsas] 1.5"),
        ("[get] [ilas] [lssr]", "[is] [lssr] 10.5"),
        ("[get] [ilas] [lsnf]", '[is] [lsnf] "a scanner"'),
        ("[set] [ilas] [lsdr] 0.5 4", "[ok]"),
        ("[set] [ilas] [lsdr] 0.5", "[fail]"),
        ("[set] [ilas] [lssr] nan", "[fail]"),
        ("[set] [ilas] [lsnf] x", "[fail]"),
        ("[get] [ilas] [bogus]", "[fail]"),
        ("[get] [ilas]", "[fail]"),
        ("[bogus] [ilas] [lsdr]", "[fail]"),
    ],
)
def test_words(client, asked, answer):
    found = client.call(Bottle.from_text(asked), timeout=HANG)
    assert Bottle(found if isinstance(found, list) else [found]).to_text() == answer


def test_functions_as_3_12_has_them(client, device):
    ask = lambda text: client.call(Bottle.from_text(text), timeout=HANG)  # noqa: E731
    assert ask("getDistanceRange [RPC]") == [0, 0.25, 8.5]
    assert ask("getDeviceInfo [RPC]") == [0, "a scanner"]
    assert ask("getDeviceStatus [RPC]") == [0, "\x01"]
    message = client.ask(Bottle.from_text("setDistanceRange [RPC] 0.5 4.5"), HANG)
    assert bytes(message.to_bytes()) == bytes(8 * [0]).replace(b"\0", b"\1", 1)
    assert device.distances == (0.5, 4.5)


def test_functions_as_4_has_them(client, device, caplog):
    caplog.set_level(logging.INFO, "yarpy.devices")
    made = client_class(IRangefinder2DMsgs)(client, HANG)
    assert made.remote_version()[:2] == (0, 3)  # who asks for it is of YARP 4
    limits = made.getScanLimits_RPC()
    assert (limits.status.code, limits.low, limits.high) == ("ok", -90.5, 90.5)
    assert made.getHorizontalResolution_RPC().value == 1.5
    assert made.getScanRate_RPC().value == 10.5
    assert made.setScanRate_RPC(5.5).code == "ok" and device.rate == 5.5
    assert made.setScanLimits_RPC(0.0, 10.5).code == "ok" and device.angles == (0.0, 10.5)
    assert made.setHorizontalResolution_RPC(2.5).code == "ok" and device.step == 2.5
    assert made.setScanRate_RPC(float("nan")).code == "err5"
    assert "not a finite number" in caplog.text


def test_who_listens_is_known(server, names, monkeypatch):
    """rangefinder2D_nwc_yarp of 4.0 asks for the angles before it asks for the version."""
    monkeypatch.setattr("yarpy.port.port.MessagePort._is_yarp4", lambda port, target: True)
    with (
        yarpy.BufferedPort("/me", names=names) as listener,
        yarpy.RpcClient("/laser/rpc:i", name="/me/rpc:o", names=names) as client,
    ):
        listener.listen_to("/laser")
        listener.read(HANG)
        answer = client.ask(Bottle.from_text("getScanLimits [RPC]"), HANG)
        assert (
            bytes(answer.to_bytes())
            .hex()
            .startswith("0001000003000000" + "0001000001000000090000006f6b0000" + "14000000")
        )


def test_a_laser_with_little_to_say(names):
    class Bare:
        def ranges(self):
            return [1, 2, 3, 4]

    with (
        LaserServer("/laser", Bare(), 0.01, names=names) as server,
        yarpy.RpcClient("/laser/rpc:i", names=names) as client,
    ):
        assert server.read("angles") == (0.0, 360.0) and server.read("step") == 90.0
        ask = lambda text: client.call(Bottle.from_text(text), timeout=HANG)  # noqa: E731
        assert ask("[get] [ilas] [lssr]") == ["fail"]
        assert ask("getScanRate [RPC]")[0] == 5
    with pytest.raises(ValueError, match=r"needs ranges\(\)"):
        LaserServer("/laser", object(), names=names)
