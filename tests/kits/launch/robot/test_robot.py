"""Robots that run: the order of everything, and what happens when something fails."""

import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from support.wait import HANG

from yarpy import Property
from yarpy.errors import LocalProtocolError, UnknownName, UnknownPlugin
from yarpy.kits.launch.robot.robot import Robot
from yarpy.kits.launch.robot.robot_file import load

from .conftest import Write

ATTACH = '<action phase="startup" level="{}" type="attach"><param name="device">{}</param></action>'


class Lab:
    """Types of devices whose instances tell here what happens to them."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.news: list[str] = []
        self.broken = {"broken"}
        self.both = threading.Barrier(2)

    def plugin(self, kind: str) -> Any:
        if kind == "nowhere":
            raise UnknownPlugin("no device of that type")
        return lambda options, *, names=None: Fake(self, options)

    def robot(self, path: Path, **more: Any) -> Robot:
        return Robot(load(path), self.plugin, news=self.news.append, **more)


class Fake:
    def __init__(self, lab: Lab, options: Property) -> None:
        self.name, self.lab = options["id"], lab
        if self.name in lab.broken:
            raise OSError("no such bus")
        lab.told.append(f"open {self.name}")

    def attach(self, devices: Mapping[str, object]) -> None:
        found = " ".join(f"{net}={getattr(one, 'name', one)}" for net, one in devices.items())
        self.lab.told.append(f"{self.name} attach {found}")

    def detach(self) -> None:
        self.lab.told.append(f"{self.name} detach")

    def calibrate(self, target: Any) -> None:
        self.lab.both.wait(HANG)  # both calibrations run at once
        self.lab.told.append(f"calibrate {target.name}")

    def close(self) -> None:
        self.lab.told.append(f"close {self.name}")
        if self.name == "sticky":
            raise RuntimeError("stuck")


@pytest.fixture
def lab() -> Lab:
    return Lab()


def test_all_of_a_life_in_order(write: Write, lab: Lab) -> None:
    robot = lab.robot(
        write(
            '<device name="a" type="t"/>'
            f'<device name="s" type="t">{ATTACH.format(10, "a")}'
            '<action phase="shutdown" level="5" type="detach"/>'
            '<action phase="interrupt1" level="1" type="abort"/></device>'
            f'<device name="m" type="t">{ATTACH.format(5, "a")}</device>'
        )
    )
    assert robot.phase == "unknown" and not robot.ready
    assert robot.start() and robot.ready
    assert lab.told == ["open a", "open s", "open m", "m attach ...=a", "s attach ...=a"]
    lab.told.clear()
    assert robot.stop() and robot.phase == "shutdown" and not robot.ready
    assert lab.told == ["s detach", "close m", "close s", "close a"]
    assert lab.news == [] and robot.stop()


def test_calibrations_of_a_level_run_side_by_side(write: Write, lab: Lab) -> None:
    start = '<action phase="startup" level="3" type="calibrate"><param name="target">'
    robot = lab.robot(
        write(
            f'<device name="a" type="t">{ATTACH.format(4, "b")}</device><device name="b" type="t">'
            f"{start}a</param></action>{start}b</param></action></device>"
        )
    )
    assert robot.start()
    assert sorted(lab.told[2:4]) == ["calibrate a", "calibrate b"], "and the next level comes later"
    robot.stop()


def test_devices_are_attached_by_network_all_of_them_or_from_outside(
    write: Write, lab: Lab
) -> None:
    path = write(
        '<device name="a" type="t"/><device name="s" type="t">'
        '<action phase="startup" level="1" type="attach"><paramlist name="networks">'
        '<elem name="x">a</elem><elem name="y">ext</elem></paramlist></action>'
        '<action phase="startup" level="2" type="attach"><param name="all">1</param></action>'
        "</device>"
    )
    robot = lab.robot(path, external={"ext": "EXT"})
    assert robot.start()
    assert lab.told[2:] == ["s attach x=a y=EXT", "s attach a=a ext=EXT"]
    robot.stop()
    assert "close ext" not in lab.told


def test_a_device_that_does_not_open_ends_it_once_all_are_tried(write: Write, lab: Lab) -> None:
    robot = lab.robot(
        write(
            '<device name="broken" type="t"/><device name="x" type="nowhere"/>'
            f'<device name="c" type="t">{ATTACH.format(1, "broken")}'
            '<action phase="shutdown" level="1" type="detach"/></device>'
        )
    )
    assert not robot.start()
    assert lab.told == ["open c", "close c"], "nothing is asked of what is not open"
    assert 'robot.xml:3:1: "broken" (t) does not open: no such bus' in lab.news[0]
    assert '"x" (nowhere) does not open: no device of that type' in lab.news[1]
    assert robot.stop() and lab.told == ["open c", "close c"]


def test_an_action_that_fails_stops_no_other_but_the_startup(write: Write, lab: Lab) -> None:
    robot = lab.robot(
        write(
            f'<device name="a" type="t">{ATTACH.format(1, "gone")}{ATTACH.format(2, "a")}</device>'
            '<device name="sticky" type="t"/>'
        )
    )
    assert not robot.start() and not robot.ready
    assert lab.told[-1] == "a attach ...=a"
    assert 'attach of "a" has failed: no device is called "gone"' in lab.news[0]
    robot.stop()
    assert lab.told[-2:] == ["close sticky", "close a"]
    assert '"sticky" does not close: stuck' in lab.news[1]


def test_one_that_keeps_going_tries_a_device_again(write: Write, lab: Lab) -> None:
    attach = ATTACH.format(1, "broken")
    path = write(f'<device name="broken" type="t"/><device name="s" type="t">{attach}</device>')
    robot = lab.robot(path, keep_going=True)
    with pytest.raises(LocalProtocolError, match="wait until it runs"):
        robot.retry("broken")
    assert robot.start() and robot.ready
    assert '"broken" is not open' in lab.news[1]
    assert not robot.retry("broken")
    assert robot.slots["broken"].state == "failed" and robot.slots["broken"].detail == "no such bus"
    lab.broken.clear()
    assert robot.retry("broken") and lab.told == ["open s", "open broken", "s attach ...=broken"]
    assert robot.retry("broken") and lab.told[-1] == "s attach ...=broken", "nothing is done twice"
    with pytest.raises(UnknownName, match='did you mean "broken"'):
        robot.retry("broke")
    robot.stop()


def test_a_device_that_serves_another_object_hands_that_in(write: Write, lab: Lab) -> None:
    class Eye:
        served = "the eye"

    path = write(f'<device name="s" type="t">{ATTACH.format(1, "eye")}</device>')
    robot = lab.robot(path, external={"eye": Eye(), "plain": object()})
    assert robot.start() and lab.told[-1] == "s attach ...=the eye"
    robot.stop()
    path = write(f'<device name="s" type="t">{ATTACH.format(1, "s")}</device>')
    robot = Robot(
        load(path), lambda kind: lambda options, *, names=None: object(), news=lab.news.append
    )
    assert not robot.start() and "have no attach()" in lab.news[-1]
    robot.stop()
