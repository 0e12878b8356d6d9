"""The monitors that come with yarpy over real ports, by the names that C++ gives them."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy import registry
from yarpy.shipped import SHIPPED

DEPTH = yarpy.Image(np.linspace(0.5, 5, 48, dtype="f4").reshape(6, 8))
RGB = yarpy.Image(np.full((8, 16, 3), (10, 200, 90), "u1"))
STREAM = yarpy.Bottle(
    [[], [], [], [[[1.0, 2.0, 3.0], 0.5]], [], [], [], [], [], [[[4.0, 5.0, 6.0], 0.5]]]
)

# Monitor and parameters, its ends, what is written, and what the reader gets (or its shape).
CASES: list[tuple[str, str, Any, Any]] = [
    ("bottle_compression_zlib", "both", ["hi", 1, [2.5]], ["hi", 1, [2.5]]),
    ("depthimage_compression_zlib", "both", DEPTH, DEPTH),
    ("image_compression_jpeg+quality.90", "both", RGB, (8, 16, 3)),
    ("image_compression_png", "both", RGB, RGB),
    ("image_rotation+options_rotate.rotate_ccw", "either", RGB, (16, 8, 3)),
    ("image_to_mono", "either", RGB, (8, 16)),
    ("depthimage_to_mono", "either", DEPTH, (6, 8)),
    ("depthimage_to_rgb", "either", DEPTH, (6, 8, 3)),
    ("depthimage_to_vector", "either", DEPTH, (48,)),
    ("segmentationimage_to_rgb", "either", np.zeros((4, 8), "u1"), (4, 8, 3)),
    ("simulated_network_delay+delay_ms.1", "either", ["hi"], ["hi"]),
    ("throttleDown+period_ms.1", "either", ["hi"], ["hi"]),
    ("sound_marker", "either", yarpy.Sound(np.zeros((2, 10), "i2")), (2, 15)),
    ("soundfilter_resample+channel.1", "either", yarpy.Sound(np.zeros((2, 10), "i2")), (1, 10)),
    ("sensorMeasurements_to_vector", "either", STREAM, [4, 5, 6, 1, 2, 3]),
    ("adaptive", "send", ["hi"], ["hi"]),
    ("bayer", "recv", np.zeros((8, 16), "u1"), (8, 16, 3)),
    ("stats_monitor", "send", ["hi"], ["hi"]),
]


def spellings() -> list[Any]:
    """Every case as a carrier string: by the monitor's own name, and as C++ YARP says it."""
    found = []
    for monitor, ends, value, expected in CASES:
        name, _, parameters = monitor.partition("+")
        cpp = "+".join(filter(None, ["portmonitor", f"file.{name}", "type.dll", parameters]))
        for spelling in (monitor,) if name == "bayer" else (monitor, cpp):
            send, recv = f"tcp+send.{spelling}", f"tcp+recv.{spelling}"
            carriers = {
                "both": [f"tcp+send.{spelling}+recv.{spelling}"],
                "either": [send, recv],
                "send": [send],
                "recv": [recv],
            }
            found += [pytest.param(c, value, expected, id=c) for c in carriers[ends]]
    one = "portmonitor+file.bottle_compression_zlib"  # the type once for both ends
    carrier = f"tcp+send.{one}+recv.{one}+type.dll"
    return [*found, pytest.param(carrier, ["hi"], ["hi"], id=carrier)]


@pytest.mark.parametrize(("carrier", "value", "expected"), spellings())
def test_over_ports(carrier: str, value: Any, expected: Any) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.connect("/in", carrier)
        assert out.write(value, yarpy.Stamp(4, 1.5)) == 1
        message = in_.read(HANG)
        assert message.stamp == yarpy.Stamp(4, 1.5)
        if isinstance(expected, tuple):
            assert message.value.array.shape == expected
        else:
            assert message.value == expected


def test_none_is_forgotten() -> None:
    """But for those that have tests of their own over ports."""
    elsewhere = {"portmonitor", "priority", "rpc_monitor"}
    assert {case[0].partition("+")[0] for case in CASES} | elsewhere >= SHIPPED["monitors"].keys()


@pytest.mark.parametrize("name", SHIPPED["monitors"])
def test_names_load(name: str) -> None:
    assert callable(registry.monitors.load(name))


@pytest.mark.parametrize("side", ["send", "recv"])
@pytest.mark.parametrize(
    "monitor",
    [
        *("bottle_compression_zlib", "depthimage_compression_zlib", "depthimage_to_rgb"),
        *("image_compression_jpeg", "image_compression_png", "image_rotation", "sound_marker"),
    ],
)
def test_what_does_not_fit_is_dropped_counted_and_told_once(
    side: str, monitor: str, caplog: pytest.LogCaptureFixture
) -> None:
    names = yarpy.LocalNames()
    fits_everything = (monitor, side) == ("bottle_compression_zlib", "send")
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.connect("/in", f"tcp+{side}.{monitor}")
        wait_until(lambda: in_.inputs)
        caplog.set_level(logging.WARNING)
        for _ in range(3):
            out.write(["no", "such", "thing"])
        if fits_everything:
            assert in_.read(timeout=HANG)
            return
        link = out.outputs[0] if side == "send" else in_.inputs[0]
        wait_until(lambda: link.stats.drops == 3)
    told = [record for record in caplog.records if "a monitor dropped a message" in record.message]
    assert len(told) == 1


def test_throttled_stream() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.connect("/in", "tcp+send.throttleDown+period_ms.100000")
        assert [out.write(number) for number in range(5)] == [1, 0, 0, 0, 0]
        assert in_.read(timeout=HANG).value == 0
        assert out.outputs[0].stats.drops == 4


def test_calls_travel_compressed_and_replies_as_they_are() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.RpcServer("/server", lambda message: message.value, names=names),
        yarpy.RpcClient(names=names) as client,
    ):
        monitor = "bottle_compression_zlib"
        client.connect("/server", f"tcp+send.{monitor}+recv.{monitor}")
        assert client.call(["x" * 1000]) == ["x" * 1000]
        assert client.outputs[0].stats.bytes < 500
