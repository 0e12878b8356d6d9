"""Inertial units on a serial line, at the other end of a pseudo terminal."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

if sys.platform == "win32":
    pytest.skip("there are no pseudo terminals", allow_module_level=True)

import tty

from support.wait import HANG, wait_until

from yarpy import Property, Timeout
from yarpy.kits.devices import MultiSensor, MultiSensorServer
from yarpy.kits.devices.hardware import imu
from yarpy.kits.devices.hardware.imu import SerialImu, witmotion_imu, xsens_imu
from yarpy.kits.devices.hardware.imu_packet import GRAVITY, witmotion
from yarpy.nameserver.local import LocalNames

UPRIGHT = bytes.fromhex("55510000000000080c0ac4") + bytes.fromhex("55520080ff7f00000000a5")
TURNED = bytes.fromhex("55510008000000000c0ac4")
# A quaternion that an MTi-300 said, alone with a counter, a time and a status.
MTI = bytes.fromhex(
    "faff3626 1020024682 10600401c4fc3e 2010103f71ce6cbea56bcf3c613bd8bd691d25 e0200400400003"
)


@contextmanager
def unit(*packets: bytes) -> Iterator[tuple[str, list[bytes]]]:
    """A line on which something is said again and again; what that is can be changed."""
    master, slave = os.openpty()
    tty.setraw(slave)
    said, over = [*packets], threading.Event()

    def speak() -> None:
        while not over.wait(0.01):
            os.write(master, b"".join(said))

    thread = threading.Thread(target=speak, daemon=True)
    thread.start()
    try:
        yield os.ttyname(slave), said
    finally:
        over.set()
        thread.join(HANG)
        os.close(slave)
        os.close(master)


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imu, "LISTENED", 0.1)


def test_on_ports(names: LocalNames) -> None:
    with unit(UPRIGHT) as (port, said):
        made = witmotion_imu(Property(port=port, sensorName="waist", frameName="root_link"))
        assert isinstance(made, SerialImu)
        with (
            made,
            MultiSensorServer("/imu", made, 0.01, names=names),
            MultiSensor("/imu", timeout=HANG, names=names) as client,
        ):
            assert client.accelerometers() == {"waist": (0.0, 0.0, GRAVITY)}
            assert client.gyroscopes()["waist"][0] == -2000.0
            assert client.orientations() == {}, "it says none"
            assert client.frames["waist"] == "root_link"
            said[:] = [TURNED]
            wait_until(lambda: client.accelerometers()["waist"][0] == GRAVITY)


def test_one_of_xsens() -> None:
    with unit(MTI + bytes((-sum(MTI[1:]) & 0xFF,))) as (port, _):
        made = xsens_imu(Property(port=port))
        assert isinstance(made, SerialImu)
        with made:
            assert [round(one) for one in made.orientations()["imu"]] == [-38, -1, -7]
            assert made.gyroscopes() == made.thermometers() == {}
            assert made.timestamps()["imu"] > 1e9


def test_it_falls_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    with unit(UPRIGHT) as (port, said), SerialImu(witmotion, port, 115_200) as found:
        monkeypatch.setattr(imu, "SILENT", 0.1)
        said.clear()

        def silent() -> bool:
            try:
                found.accelerometers()
            except Timeout as error:
                return "nothing comes any more" in str(error)
            return False

        wait_until(silent)


def test_it_is_unplugged(caplog: pytest.LogCaptureFixture) -> None:
    with unit(UPRIGHT) as (port, _):
        found = SerialImu(witmotion, port, 115_200)
    with found:
        wait_until(lambda: "is it plugged in?" in caplog.text)


def test_at_another_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imu, "FIRST", 0.2)
    with (
        unit(b"\x80\x00\xf8") as (port, _),
        pytest.raises(Timeout, match=r"no packet came .* is 9600 its speed \(--baud\)"),
    ):
        witmotion_imu(Property(port=port))


def test_parameters_that_are_wrong() -> None:
    for text, why in (("", "a serial line such as"), ("(port a) (baud fast)", "baud fast is no")):
        with pytest.raises(ValueError, match=why):
            witmotion_imu(Property.from_text(text))
