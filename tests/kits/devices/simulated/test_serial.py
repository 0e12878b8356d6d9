"""What is sent comes back."""

import pytest

from yarpy.data.bottle import Bottle
from yarpy.kits.devices.simulated import serial
from yarpy.kits.devices.simulated.serial import SimulatedSerialPort


def test_loopback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serial, "SERIAL_WAITING", 8)
    port = SimulatedSerialPort()
    port.send(Bottle(["abc"]))
    port.send(Bottle([1]))
    assert port.receive() == ["abc"] and port.receive() == []
    port.send(Bottle(["0123456789"]))
    assert port.flush() == 8 and port.receive() == []
    assert port.enable_ready_line(True) and port.ready
