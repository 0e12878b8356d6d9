"""Devices without hardware as devices of a robot's file."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from yarpy import Bottle, Property, clock
from yarpy.kits import devices
from yarpy.kits.devices.simulated import plugin
from yarpy.kits.devices.transforms.frames import Frames
from yarpy.registry import devices as plugins


def test_every_type_of_the_table_opens() -> None:
    opened = {
        name: plugins.load(name)(Property(device=name))
        for name in plugins.names()
        if plugins.load(name) is plugin.simulated
    }
    assert isinstance(opened["fakeBattery"], devices.SimulatedBattery)
    assert {*opened} == {*plugin._WITHOUT_OPTIONS}


class Told:
    """A clock that says what it is told."""

    seconds = 1000.0

    def now(self) -> float:
        return self.seconds

    def monotonic(self) -> float:
        return self.seconds

    def wait(self, event: threading.Event, seconds: float) -> bool:
        raise AssertionError("nobody waits")


@pytest.fixture
def told() -> Iterator[Told]:
    made, before = Told(), clock.current()
    clock.use(made)
    yield made
    clock.use(before)


def test_they_live_by_the_clock_of_the_program(told: Told) -> None:
    imu, sensor = devices.SimulatedImu(), devices.SimulatedPositionSensor()
    assert {*imu.timestamps().values(), *sensor.timestamps().values()} == {1000.0}
    battery, base = devices.SimulatedBattery(), devices.SimulatedBase()
    camera, deep = devices.SimulatedCamera(32, 24), devices.SimulatedDepthCamera(32, 24)
    microphone, frames = devices.SimulatedMicrophone(), Frames()
    microphone.start()
    base.apply_velocity(1.0, 0.0, 0.0, 60.0)
    frames.place("eye", "head")
    picture, depth = camera.image(), deep.depth().array
    assert battery.charge() == 100.0 and frames.all()
    told.seconds += 0.1
    assert frames.all() and (camera.image() != picture).any()
    told.seconds += 1.9
    assert battery.charge() < 100.0 and base.odometry().odom_x == pytest.approx(2.0)
    assert (deep.depth().array != depth).any()
    assert not frames.all(), "nobody has told it again"
    assert {*imu.timestamps().values(), *sensor.timestamps().values()} == {1002.0}


def test_cameras_have_the_size_that_is_asked_for() -> None:
    eye = plugin.camera(Property(width=32, height=16))
    assert eye.image().shape == (16, 32, 3)  # type: ignore[attr-defined]
    deep = plugin.depth_camera(Property(width=32, height=16))
    assert deep.depth().array.shape == (16, 32)  # type: ignore[attr-defined]
    for width in (0, "wide", 100_000):
        with pytest.raises(ValueError, match="each side must be"):
            plugin.camera(Property(width=width))


def test_an_inertial_unit_and_a_laser() -> None:
    unit: Any = plugin.imu(Property.from_text("(sensorName head) (constantValue true)"))
    assert unit.gyroscopes() == {"head": (0.0, 0.0, 0.0)}
    turning: Any = plugin.imu(Property(constantValue="false"))
    assert turning.gyroscopes() == {"sensorName": (0.0, 100.0, 0.0)}
    scanner: Any = plugin.laser(
        Property.from_text(
            "(test use_constant) (CONSTANT_MODE (const_distance 0.5)) (clip_max 1) "
            "(SENSOR (min_angle -45) (max_angle 45) (resolution 30.0))"
        )
    )
    assert scanner.ranges() == [0.5] * 3 and scanner.distances == (0.1, 1.0)
    with pytest.raises(ValueError, match="clip_max far is no number"):
        plugin.laser(Property(clip_max="far"))
    with pytest.raises(ValueError, match="no scene"):
        plugin.laser(Property(test="use_nothing"))
    with pytest.raises(ValueError, match="needs a parameter map_file"):
        plugin.laser(Property(test="use_mapfile"))


def test_a_sensor_with_channels_and_a_screen() -> None:
    sensor: Any = plugin.analog(Property(channelsNum=3))
    assert len(sensor.channels()) == 3
    assert len(plugin.analog(Property()).channels()) == 1  # type: ignore[attr-defined]
    for many in (0, "many", True, 5000):
        with pytest.raises(ValueError, match="there are 1 to 1000"):
            plugin.analog(Property(channelsNum=many))
    assert plugin.frame_writer(Property()).size is None  # type: ignore[attr-defined]
    screen: Any = plugin.frame_writer(Property(width=32, height=16))
    assert screen.size == (32, 16)
    with pytest.raises(ValueError, match="each side must be"):
        plugin.frame_writer(Property(width=-1, height=16))


def test_a_laser_in_a_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    grid = devices.Grid.of("kitchen", [[0, 100]], 0.5)
    (tmp_path / "contexts" / "rooms").mkdir(parents=True)
    path = tmp_path / "contexts" / "rooms" / "kitchen.map"
    devices.save_grid(grid, path)
    sensor = "(SENSOR (min_angle 0) (max_angle 90) (resolution 90.0))"
    named: Any = plugin.laser(
        Property.from_text(f'(test use_mapfile) (map_file "{path.as_posix()}") {sensor}')
    )
    named.place = (0.25, 0.25, 0.0)
    assert named.ranges() == [0.25]
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path))
    text = f"(test use_mapfile) (map_file kitchen.map) (map_context rooms) {sensor}"
    assert plugin.laser(Property.from_text(text)).ranges() == [0.5]  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match=r"no file hall\.map in the context rooms"):
        plugin.laser(Property.from_text(text.replace("kitchen", "hall")))
    with pytest.raises(FileNotFoundError):
        plugin.laser(Property.from_text(text.replace(" (map_context rooms)", "")))


def test_joints_have_names() -> None:
    def board(text: str) -> devices.SimulatedJoints:
        return plugin.joints(Property.from_text(text))  # type: ignore[return-value]

    assert board("").axis_names == ["joint0", "joint1", "joint2", "joint3"]
    assert board("(GENERAL (Joints 2))").axis_names == ["joint0", "joint1"]
    assert board("(GENERAL (Joints 2) (AxisName a b))").axis_names == ["a", "b"]
    assert board("(GENERAL (Joints 2) (AxisName (a b)))").axis_names == ["a", "b"]
    with pytest.raises(ValueError, match="1 names for 2 joints"):
        board("(GENERAL (Joints 2) (AxisName a))")
    for joints in ("0", "many", "1.5"):
        with pytest.raises(ValueError, match="there are 1 to"):
            board(f"(GENERAL (Joints {joints}))")


def test_values_are_a_list_or_stand_side_by_side() -> None:
    assert plugin.values(Property.from_text("(a 1 2)"), "a") == [1, 2]
    assert plugin.values(Property.from_text("(a (1 2))"), "a") == [1, 2]
    assert plugin.values(Property(a=Bottle([1])), "b") == []
