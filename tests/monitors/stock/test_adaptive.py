"""adaptive: what passes, how small it is made; with a clock and a link that the test turns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.monitor import place

from yarpy import Bottle, Image, LocalProtocolError
from yarpy.data.bottle import Property
from yarpy.monitors.base import Place, Taken
from yarpy.monitors.stock.adaptive import Adaptive
from yarpy.wire.message import CALL, DATA, Message

PERIOD = 1 / 30
JPEG = "tcp+send.adaptive{}+recv.image_compression_jpeg"


class Stream:
    """A camera, a link of `speed` bytes per second, and the monitor between them."""

    def __init__(self, tokens: str = "", jpeg: bool = False, speed: float = 1e9) -> None:
        self.now, self.speed, self.under_way = 1000.0, speed, 0
        self.sizes: list[int] = []
        self.images: list[Image] = []
        self._free = 0.0  # when the link has taken the last one
        at = place(tokens, sending=True)
        if jpeg:
            at = Place("/out", "/in", JPEG.format(""), True, at.tokens, at.tokens)
        self.monitor = Adaptive(at, lambda: self.now)
        self.monitor.watch(lambda: self.under_way)

    def write(self, value: object, key: str = DATA) -> bool:
        """Whether it passes; at the end of the period it may have been confirmed."""
        message = Message(key, value, "", "object")
        passed = self.monitor.accept(message)
        if passed:
            made = self.monitor.update(message) or message
            size = len(made.to_bytes())
            self.sizes.append(size)
            if isinstance(made.value, Image):
                self.images.append(made.value)
            self.under_way, self._took = 1, size / self.speed
            self._free = self.now + self._took
        self.now += PERIOD
        if self.under_way and self._free <= self.now:
            self.under_way = 0
            self.monitor.confirmed(Taken(self.sizes[-1], self._took))
        return passed

    def run(self, seconds: float, value: object) -> int:
        """Write for so long; how many passed."""
        return sum(self.write(value) for _ in range(int(seconds / PERIOD)))


def picture(height: int = 240, width: int = 320) -> Any:
    random = np.random.default_rng(1)
    return np.clip(random.normal(128, 30, (height, width, 3)), 0, 255).astype("u1")


def test_a_fast_link_is_left_alone() -> None:
    stream = Stream()
    assert stream.run(1, picture()) == 30
    assert set(stream.sizes) == {240 * 320 * 3 + 60}
    assert stream.monitor.state()["skipped"] == 0


def test_a_busy_link_gets_nothing() -> None:
    stream = Stream()
    stream.under_way = 2
    stream._free = float("inf")
    assert not stream.write([1, 2])
    stream.under_way = 0
    assert stream.write([1, 2])
    assert stream.monitor.state()["skipped"] == 1


def test_questions_pass_as_they_are() -> None:
    stream = Stream("mbit.0.001")
    stream.under_way, stream._free = 2, float("inf")
    message = Message(CALL, picture(), "", "object")
    assert stream.monitor.accept(message)
    assert stream.monitor.update(message) is None


def test_jpeg_becomes_worse_on_a_slow_link_and_better_again() -> None:
    stream = Stream(jpeg=True, speed=6e6)
    stream.run(3, picture())
    free = stream.sizes[-1]
    stream.speed = 300e3
    stream.run(2, picture())
    stream.sizes.clear()
    passed = stream.run(6, picture())
    assert passed > 0.8 * 180
    assert 0.5 * 10e3 < sum(stream.sizes) / len(stream.sizes) < 10e3  # what the link takes
    assert int(stream.monitor.state()["quality_now"]) < 60  # type: ignore[call-overload]
    stream.speed = 6e6
    stream.run(6, picture())
    assert stream.sizes[-1] > 0.9 * free


def test_images_become_smaller_where_there_is_no_jpeg() -> None:
    stream = Stream(speed=600e3)
    stream.run(3, picture())
    assert (stream.images[-1].width, stream.images[-1].height) == (80, 60)
    assert abs(int(stream.images[-1].array.mean()) - 128) < 3
    stream.speed = 100e6
    stream.run(8, picture())
    assert len(picture().tobytes()) + 60 == stream.sizes[-1]


@pytest.mark.parametrize("code", ["mono", "rgba", "dec", "mo16"])
@pytest.mark.parametrize("shape", [(241, 323), (64, 64)])
def test_every_kind_of_pixels(code: str, shape: tuple[int, int]) -> None:
    kinds = {"mono": ("u1", ()), "rgba": ("u1", (4,)), "dec": ("f4", ()), "mo16": ("u2", ())}
    dtype, rest = kinds[code]
    image = Image(np.ones((*shape, *rest), dtype), code)
    stream = Stream(speed=3 * image.array.nbytes)
    stream.run(6, image)
    made = stream.images[-1]
    assert str(made.code) == code
    assert made.width in (shape[1] // 4, -(-shape[1] // 4))
    assert made.array.min() == made.array.max() == 1


def test_what_it_does_not_know_passes_unchanged() -> None:
    stream = Stream(speed=30e3)
    stream.run(3, Image(np.zeros((64, 64), "u1"), "rggb"))
    stream.write(["a", "list"])
    assert {*stream.sizes} <= {64 * 64 + 60, len(Bottle(["a", "list"]).to_bytes())}


def test_a_limit() -> None:
    stream = Stream("mbit.0.8")  # 100 kB/s
    passed = stream.run(10, "x" * 10_000)
    assert 90 <= passed <= 110
    stream.sizes.clear()
    stream.monitor.configure(Property(mbit=0))
    assert stream.run(1, "x" * 10_000) == 30


def test_a_limit_makes_jpeg_smaller_first() -> None:
    stream = Stream("mbit.2.4", jpeg=True)
    stream.run(5, picture())
    stream.sizes.clear()
    passed = stream.run(5, picture())
    assert passed > 0.8 * 150
    assert sum(stream.sizes) < 1.1 * 5 * 300e3


def test_parameters() -> None:
    monitor = Stream("delay_ms.50+quality.80").monitor
    assert monitor.parameters() == {"delay_ms": 50, "quality": 80, "mbit": 0}
    monitor.configure(Property(quality=70))
    assert monitor.parameters()["quality"] == 70
    for wrong in ({"quality": 0}, {"mbit": "much"}, {"delay_ms": float("nan")}):
        with pytest.raises(LocalProtocolError):
            monitor.configure(Property(wrong))
    assert monitor.parameters() == {"delay_ms": 50, "quality": 70, "mbit": 0}


@pytest.mark.parametrize("tokens", ["quality.0", "mbit.-1", "delay_ms.soon"])
def test_wrong_parameters(tokens: str) -> None:
    with pytest.raises(LocalProtocolError, match="takes a number"):
        Adaptive(place(tokens, sending=True))


def test_the_wrong_end() -> None:
    with pytest.raises(LocalProtocolError, match="sender's end"):
        Adaptive(place())
