"""A link that becomes slow: `+send.adaptive` keeps images young, for real.

The loopback of a network namespace is shaped (tbf), and a program in it has both ports. Needs root
and iproute2.
"""

import json
import os
import sys
from collections.abc import Iterator

import pytest
from support.namespace import ip
from support.peer import brings
from support.process import Process
from support.wait import HANG, wait_until

NAME = f"y{os.getpid() % 10000}slow"
# For each line, a number of seconds, it prints how old images were, and their bytes.
PROGRAM = """
import sys, time, json, numpy as np, yarpy
names = yarpy.LocalNames()
noise = np.random.default_rng(1).normal(128, 30, (240, 320, 3))
image = np.clip(noise, 0, 255).astype("u1")
found = []
def see(message):
    found.append(time.time() - message.stamp.time)
with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort(
    "/in", callback=see, names=names
):
    out.connect("/in", "tcp+send.adaptive+recv.image_compression_jpeg")
    print("ready", flush=True)
    for line in sys.stdin:
        found.clear()
        before = out.outputs[0].stats.bytes
        due = time.monotonic()
        for _ in range(int(float(line) * 20)):
            due += 0.05
            time.sleep(max(0.0, due - time.monotonic()))
            out.write(image, yarpy.Stamp(1, time.time()))
        size = out.outputs[0].stats.bytes - before
        state = yarpy.admin("/out", "prop", "get", "/in", names=names).to_text()
        print(json.dumps({"ages": found, "bytes": size, "state": state}), flush=True)
"""


@pytest.fixture
@brings("namespaces")
def slow() -> Iterator[str]:
    """A namespace with a loopback of 4 Mbit/s."""
    try:
        ip("netns", "add", NAME)
        ip("-n", NAME, "link", "set", "lo", "mtu", "1500", "up")
        yield NAME
    finally:
        ip("netns", "del", NAME, check=False)


def shape(mbit: float) -> None:
    ip("netns", "exec", NAME, "tc", "qdisc", "replace", "dev", "lo", "root", "tbf",
       "rate", f"{mbit}mbit", "burst", "16kb", "latency", "200ms")  # fmt: skip


def test_images_shrink_until_the_link_takes_them(slow: str) -> None:
    shape(100)
    command = ["ip", "netns", "exec", slow, sys.executable, "-c", PROGRAM]

    def run(process: Process, seconds: float) -> dict:
        count = process.stdout.count("ages")
        process.write_line(str(seconds))
        wait_until(lambda: process.stdout.count("ages") > count, timeout=60)
        return json.loads(process.stdout.splitlines()[-1])

    with Process(command, env=dict(os.environ)) as process:
        process.wait_line("ready", timeout=HANG)
        free = run(process, 1.5)
        shape(2)
        run(process, 2.0)
        slowed = run(process, 2.0)
        # A whole image takes 150 ms and more there; what comes now is a fraction of it.
        assert len(free["ages"]) > 5 and len(slowed["ages"]) > 5
        sizes = [one["bytes"] / max(1, len(one["ages"])) for one in (free, slowed)]
        assert sizes[1] < 0.5 * sizes[0]
        assert "mbit_now" in slowed["state"]
