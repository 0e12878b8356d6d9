"""A device with two ports: their names, how long a measurement counts, what closes if it fails."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.errors import RemoteProtocolError, Timeout, UnknownName
from yarpy.kits.devices.remote_device import TIMEOUT, RemoteDevice


class Lamp(RemoteDevice[float]):
    RPC = "/ask", "/asks"
    DATA = "/bright:o", "/bright:i"
    FRESH = HANG

    def bright(self) -> float:
        return self._latest.value()

    def _learn(self) -> None:
        self.kind = self._rpc.call(["kind"], timeout=TIMEOUT)
        if self.kind != "lamp":
            raise RemoteProtocolError("no lamp")

    def _decode(self, message):
        return float(message.as_(float))


def test_its_ports(names):
    with (
        yarpy.RpcServer("/lamp/ask", lambda message: "lamp", names=names),
        yarpy.Port("/lamp/bright:o", names=names) as source,
        Lamp("lamp/", "mine", names=names) as lamp,
    ):
        source.write(0.5)
        assert lamp.bright() == 0.5 and lamp.kind == "lamp"
        assert repr(lamp) == "<Lamp /lamp>"
        assert names.query("/mine/asks") and names.query("/mine/bright:i")


def test_how_long_a_measurement_counts(names):
    with (
        yarpy.RpcServer("/lamp/ask", lambda message: "lamp", names=names),
        yarpy.Port("/lamp/bright:o", names=names),
        Lamp("/lamp", names=names, timeout=0.01) as lamp,
        pytest.raises(Timeout, match=r"0\.01 s"),
    ):
        lamp.bright()


def test_what_is_open_closes_when_it_cannot_be_used(names):
    with yarpy.RpcServer("/lamp/ask", lambda message: "toaster", names=names):
        with pytest.raises(RemoteProtocolError, match="no lamp"):
            Lamp("/lamp", "/mine", names=names)
        assert names.query("/mine/asks") is None
    with pytest.raises(UnknownName):
        Lamp("/lamp", "/mine", names=names)
