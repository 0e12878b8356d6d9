"""A RealSense camera that is not there: its maker's library records a device of software, and plays
that as a camera."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.wait import wait_until

from yarpy import Image, Property
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices import DepthCamera
from yarpy.kits.devices.hardware.realsense import Realsense, realsense
from yarpy.kits.devices.interfaces.depth import STATES
from yarpy.kits.devices.wrapper import server_of
from yarpy.nameserver.local import LocalNames

WIDTH, HEIGHT, FRAMES = 64, 48, 5


def stream(rs: Any, kind: Any, number: int, form: Any, depth: int) -> Any:
    found = rs.video_stream()
    found.type, found.index, found.uid, found.fmt = kind, 0, number, form
    found.width, found.height, found.fps, found.bpp = WIDTH, HEIGHT, 30, depth
    lens = rs.intrinsics()
    lens.width, lens.height, lens.ppx, lens.ppy = WIDTH, HEIGHT, 31.5, 23.5
    lens.fx = lens.fy = 60.0
    lens.model, lens.coeffs = rs.distortion.brown_conrady, [0.0] * 5
    found.intrinsics = lens
    return found


def frame(rs: Any, profile: Any, pixels: Any, number: int) -> Any:
    found = rs.software_video_frame()
    found.pixels, found.stride, found.bpp = pixels, pixels.strides[0], pixels.strides[1]
    found.timestamp, found.frame_number = 33.0 * number, number
    found.domain = rs.timestamp_domain.system_time
    found.profile = profile.as_video_stream_profile()
    return found


class Silent:
    """A pipeline from which nothing comes any more."""

    def __init__(self, pipeline: Any) -> None:
        self.stop = pipeline.stop

    def try_wait_for_frames(self, milliseconds: int) -> tuple[bool, None]:
        return False, None


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Pictures whose red is 10 to 50, and which are as many centimetres away."""
    rs = pytest.importorskip("pyrealsense2", reason="needs: pip install 'yarpy[realsense]'")
    path = str(tmp_path_factory.mktemp("realsense") / "recording.db3")
    device = rs.software_device()
    device.register_info(rs.camera_info.name, "D435 of software")
    sensors = device.add_sensor("Stereo Module"), device.add_sensor("RGB Camera")
    depth = sensors[0].add_video_stream(stream(rs, rs.stream.depth, 0, rs.format.z16, 2))
    colour = sensors[1].add_video_stream(stream(rs, rs.stream.color, 1, rs.format.rgb8, 3))
    sensors[0].add_read_only_option(rs.option.depth_units, 0.001)
    same = rs.extrinsics()
    same.rotation, same.translation = [1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]
    depth.register_extrinsics_to(colour, same)
    colour.register_extrinsics_to(depth, same)
    recorder = rs.recorder(path, device)
    taken: Any = rs.frame_queue(100)
    recorded = recorder.query_sensors()
    for sensor in recorded:
        sensor.open(sensor.get_stream_profiles()[0])
        sensor.start(taken)
    for number in range(1, FRAMES + 1):
        far = np.full((HEIGHT, WIDTH), 100 * number, "u2")
        seen = np.zeros((HEIGHT, WIDTH, 3), "u1")
        seen[..., 0] = 10 * number
        sensors[0].on_video_frame(frame(rs, depth, far, number))
        sensors[1].on_video_frame(frame(rs, colour, seen, number))
        time.sleep(0.033)  # so fast will it be shown
    for _ in range(2 * FRAMES):
        assert taken.wait_for_frame(10_000)
    for sensor in recorded:
        sensor.stop()
        sensor.close()
    return path


def shown(device: Any, which: str) -> Image:
    """The next picture, or distances."""
    found: list[Image] = []

    def there() -> bool:
        found.extend(filter(None, (getattr(device, which)(),)))
        return bool(found)

    wait_until(there)
    return found[0]


def test_pictures_and_distances(recording: str) -> None:
    with Realsense(file=recording) as camera:
        for _ in range(3):
            colour, depth = shown(camera, "colour"), shown(camera, "depth")
            assert colour.array.shape == (HEIGHT, WIDTH, 3)
            assert depth.array.shape == (HEIGHT, WIDTH)
            number = int(colour.array[0, 0, 0])
            assert number in range(10, 51, 10)
            middle = float(depth.array[HEIGHT // 2, WIDTH // 2])
            assert middle == pytest.approx(number / 100), "both are of one moment"


def test_what_it_is(recording: str) -> None:
    with Realsense(file=recording) as camera:
        assert camera.colour_resolution() == camera.depth_resolution() == (WIDTH, HEIGHT)
        assert camera.description() == (2, "D435 of software")
        assert camera.colour_field_of_view()[0] == pytest.approx(56.1, abs=0.1)
        lens = camera.depth_intrinsics()
        assert lens["focalLengthX"] == 60.0
        assert lens["principalPointY"] == 23.5
        assert lens["distortionModel"] == "none"
        camera._lens.coeffs = [0.5, 0.0, 0.0, 0.0, 0.25]
        assert camera.colour_intrinsics()["distortionModel"] == "plumb_bob"
        assert camera.colour_intrinsics()["k3"] == 0.25
        assert (camera.status(), camera.last_error()[0]) == (2, "")
        assert [one.width for one in camera.configurations()] == [WIDTH]
        assert server_of(camera, "realsense2") == "RGBDSensor_nws_yarp"


def test_it_falls_silent(
    recording: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    with Realsense(file=recording) as camera:
        shown(camera, "colour")
        monkeypatch.setattr("yarpy.kits.devices.hardware.realsense._SILENT", 0.0)
        monkeypatch.setattr(camera, "_pipeline", Silent(camera._pipeline))
        wait_until(lambda: camera.last_error()[0] != "")
        assert STATES[camera.status()] == "error"
    assert "is it plugged in?" in caplog.text


def test_on_ports(recording: str, names: LocalNames) -> None:
    made: Any = realsense(Property(file=recording))
    with (
        made,
        DepthCamera.serve("/camera", made, period=0.01, names=names),
        DepthCamera.connect("/camera", names=names) as client,
    ):
        assert client.colour_width() == WIDTH
        assert client.description() == (2, "D435 of software")
        assert not client.has_feature(1)
        assert shown(client, "depth").array.dtype == np.float32


def test_no_camera(tmp_path: Path) -> None:
    pytest.importorskip("pyrealsense2", reason="needs: pip install 'yarpy[realsense]'")
    with pytest.raises(OSError, match="a RealSense camera 12 does not open with 640 x 480"):
        Realsense(serial="12")
    with pytest.raises(OSError, match=r"none\.db3 does not open"):
        Realsense(file=str(tmp_path / "none.db3"))


def test_without_its_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyrealsense2", None)
    with pytest.raises(UnknownPlugin, match=r"yarpy\[realsense\]"):
        Realsense()


def test_parameters_that_are_wrong() -> None:
    with pytest.raises(ValueError, match="width wide, height 480 and rate 30"):
        realsense(Property(width="wide"))
