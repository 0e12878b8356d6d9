"""The status in front of an answer depends on who asks."""

from types import SimpleNamespace
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.kits.devices.battery.functions import IBatteryMsgs, Info
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.service import DeviceService


class Battery(IBatteryMsgs, DeviceService):
    def getBatteryInfoRPC(self) -> Info:  # noqa: N802
        return Info(Status("ok"), "a battery")


def ask(service: Battery, name: str, source: str) -> Any:
    data = Bottle([name]).to_bytes()
    message = SimpleNamespace(
        to_bytes=lambda: data, source=source, spelling="binary", wants_reply=True
    )
    return b"".join(service(message).to_wire())


def test_who_gets_which() -> None:
    service = Battery()
    info = "getBatteryInfoRPC"
    older = Bottle([0, "a battery"]).to_bytes()
    assert ask(service, info, "/old") == older
    assert len(ask(service, "getRemoteProtocolVersion", "/new")) == 16
    newer = ask(service, info, "/new")
    assert newer != older and Bottle.from_bytes(newer) == [["ok"], "a battery"]
    assert ask(service, info, "/old") == older
    service.speaks_yarp4("/old")
    assert ask(service, info, "/old") == newer and service.knows("/old")
    assert not service.knows("/floats")
    service._note("/floats", True)  # it has sent a float as YARP 4 spells it
    assert service.knows("/floats") and ask(service, info, "/floats") == newer
    for number in range(200):
        service.speaks_yarp4(f"/{number}")
    assert not service.knows("/old") and service.knows("/199")
    assert Bottle.from_bytes(ask(service, "nonsense", "/old"))[0] == "fail"
