import logging

from yarpy.kits.devices import refusal
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused


def test_the_same_complaint_is_logged_once_in_a_while(caplog, monkeypatch):
    complain = DeviceErrorLog("/head")
    with caplog.at_level(logging.WARNING):
        for _ in range(100):
            complain("encoders", OSError("cable"))
        complain("torques", OSError("cable"))
        complain("encoders", Refused("something else"))
        monkeypatch.setattr(refusal, "QUIET", -1.0)
        complain("encoders", Refused("something else"))
    assert [record.getMessage() for record in caplog.records] == [
        "/head: encoders: OSError: cable",
        "/head: torques: OSError: cable",
        "/head: encoders: something else",
        "/head: encoders: something else",
    ]


def test_not_everything_is_remembered():
    complain = DeviceErrorLog("/head")
    for number in range(1000):
        complain(f"command from /p{number}", Refused("bad"))
    assert len(complain._said) <= 200
