"""A remote battery: of C++ 4.0.0 as recorded, of older ones, of yarpy; and behind another."""

import pytest
from kits.devices.battery.test_server import Pack
from support.wait import HANG, wait_until
from support.yarp4 import replay_device

import yarpy
from yarpy import Bottle
from yarpy.errors import DecodeError, LocalProtocolError, UnknownName
from yarpy.kits.devices.battery.client import Battery
from yarpy.kits.devices.battery.server import BatteryServer


@pytest.mark.parametrize("newer", [False, True])
def test_of_yarpy(names, newer):
    with (
        BatteryServer("/battery", Pack(), 0.01, newer=newer, names=names),
        Battery("/battery", names=names, timeout=HANG) as near,
        BatteryServer("/relay", near, 0.01, names=names),
        Battery("/relay", names=names, timeout=HANG) as battery,
    ):
        assert (battery.charge(), battery.voltage(), battery.current()) == (80.5, 24.5, 1.5)
        assert battery.temperature() == 20 and battery.status() == "charging"
        assert battery.info == "24 V" and battery.timestamp() > 1e9


def test_of_cpp_4(names):
    with (
        replay_device("battery", "/battery/rpc:i", "/battery/data:o", names),
        Battery("/battery", names=names, timeout=HANG) as battery,
    ):
        assert 0 < battery.charge() <= 50 and battery.voltage() == 30.0
        assert battery.current() == 3.0 and battery.temperature() == 20.0
        assert battery.status() == "in use" and battery.info == "Fake battery system v2.0"


def test_of_older_cpp(names):
    def answer(message):
        if message.value == ["ibat", "btnf"]:
            return Bottle.from_text('[is] [btnf] "an old one"')
        return Bottle.from_text("[fail]")

    with (
        yarpy.RpcServer("/battery/rpc:i", answer, names=names),
        yarpy.BufferedPort("/battery/data:o", names=names) as source,
        Battery("/battery", names=names, timeout=HANG) as battery,
    ):
        source.write([30.0, 3.0, 48.5, 20.0, 99])
        assert battery.charge() == 48.5 and battery.voltage() == 30.0
        assert battery.status() == "error" and battery.info == "an old one"

        def refused():
            source.write(["no", "battery"])
            try:
                battery.charge()
            except DecodeError:
                return True
            return False

        wait_until(refused)


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        Battery("/nobody", names=names)

    with (
        yarpy.RpcServer("/battery/rpc:i", lambda message: Bottle.from_text("[fail]"), names=names),
        yarpy.BufferedPort("/battery/data:o", names=names),
        Battery("/battery", names=names) as battery,
        pytest.raises(LocalProtocolError, match="does not say what it is"),
    ):
        assert battery.info
