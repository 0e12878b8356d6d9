"""A battery on ports: what programs of several versions get."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.battery.functions import IBatteryMsgs
from yarpy.kits.devices.battery.server import BatteryServer
from yarpy.kits.thrift.client import client_class


class Pack:
    info = "24 V"

    def charge(self):
        return 80.5

    def voltage(self):
        return 24.5

    def current(self):
        return 1.5

    def temperature(self):
        return 20

    def status(self):
        return "charging"


@pytest.fixture
def server(names):
    with BatteryServer("/battery", Pack(), 0.01, names=names) as server:
        yield server


def first(names, **options):
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/battery/data:o")
        return port.read(HANG)


def test_what_is_sent(server, names):
    message = first(names)
    assert message.value == [24.5, 1.5, 80.5, 20.0, 1]
    assert message.stamp.time > 1e9


def test_programs_of_3_12_have_another_order(names):
    with BatteryServer("/battery", Pack(), 0.01, newer=True, names=names):
        assert first(names).value == [80.5, 24.5, 1.5, 20.0, 1]


def test_programs_of_4_get_its_form(server, names, monkeypatch):
    monkeypatch.setattr("yarpy.port.port.MessagePort._is_yarp4", lambda port, target: True)
    data = bytes(first(names).payload)
    assert data.hex().startswith("0001000005000000" + "14000000" + "0000000000205440")


def test_a_battery_with_little_to_say(names):
    class Bare:
        def charge(self):
            return 50

    with BatteryServer("/battery", Bare(), 0.01, names=names):
        assert first(names).value == [0.0, 0.0, 50.0, 0.0, 2]
    with pytest.raises(ValueError, match=r"needs charge\(\)"):
        BatteryServer("/battery", object(), names=names)


def test_what_is_asked(server, names):
    with yarpy.RpcClient("/battery/rpc:i", names=names) as client:
        asked = [Vocab("ibat"), Vocab("btnf")]
        assert client.call(asked, timeout=HANG) == ["is", "btnf", "24 V"]
        info = Bottle(["getBatteryInfoRPC"])
        assert client.call(info, timeout=HANG) == [0, "24 V"]  # as 3.12 has it
        made = client_class(IBatteryMsgs)(client, HANG)
        assert made.remote_version() == (0, 3, 11, 0)
        assert client.call(info, timeout=HANG) == [["ok"], "24 V"]
        assert client.call(Bottle(["nonsense"]), timeout=HANG)[0] == "fail"
