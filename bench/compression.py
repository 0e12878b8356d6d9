"""What the monitors that work on pictures cost: compression both ways, and Bayer patterns.

One thread, no network. A picture of 640x480 with some noise, as a camera has it; the best of some
rounds counts. `share` is how much of the time another Python thread could run: what a library
that lets the interpreter go is for.

    python bench/compression.py [--rounds 20]
"""

from __future__ import annotations

import argparse
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from yarpy import Image, registry
from yarpy.monitors.base import Place
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message, Packet

COMPRESSION = (
    ("bottle_compression_zlib", "rgb"),
    ("depthimage_compression_zlib", "depth"),
    ("image_compression_jpeg", "rgb"),
    ("image_compression_png", "rgb"),
)
WATCHED = 0.5  # seconds
METHODS = ["nearest", "simple", "bilinear", "hqlinear", "downsample", "ahd", "vng", "edgesense"]


def pictures() -> dict[str, Image]:
    """The pictures of a camera: colours, depth in metres, and a Bayer pattern."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:480, 0:640]
    waves = [np.sin(x / (20 + 9 * index)) * np.cos(y / 15) for index in range(3)]
    colours = 128 + 90 * np.stack(waves, axis=-1) + random.normal(0, 3, (480, 640, 3))
    rgb = np.clip(colours, 0, 255).astype("u1")
    depth = (2 + np.sin(x / 90) + random.normal(0, 0.001, x.shape)).astype("f4")
    return {"rgb": Image(rgb), "depth": Image(depth), "bayer": Image(rgb[..., 1].copy())}


def monitor(name: str, tokens: str = "", sending: bool = False) -> Any:
    own = parse_carrier(f"x+{tokens}").tokens if tokens else ()
    return registry.monitors.load(name)(Place("/out", "/in", "", sending, own, own))


def updated(one: Any, message: Message) -> Message:
    made = one.update(message)
    return made if isinstance(made, Message) else message.replaced(made)


def best(work: Callable[[], object], rounds: int) -> float:
    """Seconds that `work` takes when nothing disturbs it."""
    found = float("inf")
    for _ in range(rounds):
        started = time.perf_counter()
        work()
        found = min(found, time.perf_counter() - started)
    return found


def share(work: Callable[[], object]) -> float:
    """How fast another Python thread counts while `work` goes on; 1: as if it were alone."""
    counts = [0.0]
    stop = threading.Event()

    def count() -> None:
        while not stop.is_set():
            counts[0] += 1

    def rate(while_: Callable[[], object]) -> float:
        before, started = counts[0], time.perf_counter()
        while time.perf_counter() - started < WATCHED or counts[0] == before:
            while_()
        return (counts[0] - before) / (time.perf_counter() - started)

    thread = threading.Thread(target=count)
    thread.start()
    while not counts[0]:
        time.sleep(0.001)
    alone = rate(lambda: time.sleep(0.1))
    beside = rate(work)
    stop.set()
    thread.join()
    return beside / alone


def main() -> None:
    parser = argparse.ArgumentParser(description="What monitors for pictures cost.")
    parser.add_argument("--rounds", type=int, default=20)
    rounds = parser.parse_args().rounds
    seen = pictures()
    print("| monitor | MB | becomes | compress MB/s | share | decompress MB/s | share |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for name, kind in COMPRESSION:
        there, back = monitor(name, sending=True), monitor(name)
        plain = Packet(seen[kind])
        packed = bytes(updated(there, Message.of(plain)).to_bytes())
        size = sum(memoryview(block).nbytes for block in plain.blocks)
        row = [f"{size / 1e6:.2f}", f"{len(packed) / size:.0%}"]
        for work in (
            lambda there=there, plain=plain: updated(there, Message.of(plain)).to_bytes(),
            lambda back=back, packed=packed: updated(back, Message(DATA, packed)).to_bytes(),
        ):
            row += [f"{size / best(work, rounds) / 1e6:.0f}", f"{share(work):.0%}"]
        print(f"| {name} | {' | '.join(row)} |")
    print("\n| bayer | ms |\n|---|--:|")
    data = b"".join(seen["bayer"].to_wire())
    for method in METHODS:
        one = monitor("bayer", f"method.{method}")
        took = best(lambda one=one: one.update(Message(DATA, data)), rounds)
        print(f"| {method} | {took * 1000:.2f} |")


if __name__ == "__main__":
    main()
