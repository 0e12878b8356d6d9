"""The second experiment of docs/qos.md: images over a link that becomes ten times slower.

A camera of 30 images per second (640x480 with some noise) over a link of 50 Mbit/s, then 5,
then 50 again: raw, as JPEG (`+send.image_compression_jpeg`), and with `+send.adaptive`. What counts
is how old an image is when it arrives (one clock for both programs), how many arrive, and how much
of the link is used.

    sudo .venv/bin/python bench/adaptive.py [--seconds 12] [--rounds 3] [--plot FILE.svg]
"""

import argparse
import json
import statistics
import sys
import threading
import time
from pathlib import Path

import numpy as np
from hosts import Hosts, Idle, ask, say, serve_names

import yarpy

FPS = 30.0
QUALITY = 90
HIGH, LOW = 50.0, 5.0  # Mbit/s
ENDS = "/camera/out", "/viewer/in"
RECEIVED = "recv.image_compression_jpeg"
WAYS = {
    "raw": "tcp",
    "JPEG": f"tcp+send.image_compression_jpeg+quality.{QUALITY}+{RECEIVED}",
    "adaptive": f"tcp+send.adaptive+quality.{QUALITY}+{RECEIVED}",
}


def scene() -> list[np.ndarray]:
    """Images of shapes and noise: about 150 kB of JPEG each."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:480, 0:640]
    found = []
    for turn in range(8):
        soft = 128 + 90 * np.sin(x / 40 + turn) * np.cos(y / 30 - turn)
        noise = random.normal(0, 28, (480, 640, 3))
        found.append(np.clip(soft[..., None] + noise, 0, 255).astype("u1"))
    return found


def camera() -> None:
    """Writes an image in each period, with the time; a camera that is late skips."""
    images = scene()
    with yarpy.Port(ENDS[0]) as out:
        print("ready", flush=True)
        number, due = 0, time.monotonic()
        while True:
            due = max(due + 1 / FPS, time.monotonic() - 1 / FPS)
            time.sleep(max(0.0, due - time.monotonic()))
            number += 1
            # The time at which the camera saw it: for a writer that is held up, before it waited.
            out.write(images[number % len(images)], yarpy.Stamp(number, time.time()))


def viewer() -> None:
    """Prints the ages of what came since the last line."""
    came: list[tuple[float, float]] = []
    lock = threading.Lock()

    def see(message: yarpy.Message) -> None:
        now = time.time()
        with lock:
            came.append((now, now - message.stamp.time))

    with yarpy.BufferedPort(ENDS[1], callback=see):
        print("ready", flush=True)
        for _ in sys.stdin:
            with lock:
                print(json.dumps(came), flush=True)
                came.clear()


PROGRAMS = {"names": serve_names, "camera": camera, "viewer": viewer}


def measure(hosts: Hosts, options: argparse.Namespace) -> dict[str, dict[str, list]]:
    """Ages by way and phase, bytes on the link, and the course of the first round."""
    hosts.start("switch", "names")
    sees = hosts.start("sub", "viewer")
    hosts.start("pub", "camera")
    found: dict = {way: {"ages": {}, "mbit": {}, "course": []} for way in WAYS}
    with hosts.entered():
        for number in range(options.rounds):
            for way in list(WAYS)[:: 1 if number % 2 == 0 else -1]:
                say(f"round {number + 1} of {options.rounds}: {way}")
                hosts.shape(HIGH)
                link = yarpy.connect(*ENDS, WAYS[way])
                time.sleep(3)
                ask(sees, "")
                began = time.time()
                for phase, mbit in (("50", HIGH), ("5", LOW), ("50 again", HIGH)):
                    hosts.shape(mbit)
                    before = hosts.carried("sub")
                    since = time.monotonic()
                    time.sleep(options.seconds)
                    passed = time.monotonic() - since
                    used = (hosts.carried("sub") - before) * 8e-6 / passed
                    ages = json.loads(ask(sees, ""))
                    one = found[way]
                    one["ages"].setdefault(phase, []).extend(age for _, age in ages)
                    one["mbit"].setdefault(phase, []).append(used)
                    if number == 0:
                        one["course"] += [(at - began, age) for at, age in ages]
                link.close()
                time.sleep(1)
    return found


def table(found: dict, options: argparse.Namespace) -> list[str]:
    lines = [
        "| link Mbit/s | | images/s | mean ms | 95 % ms | worst ms | x unloaded | link used |",
        "|---|---|--:|--:|--:|--:|--:|--:|",
    ]
    free = quantile(found["JPEG"]["ages"]["50"], 0.5)
    for phase in found["JPEG"]["ages"]:
        for way, one in found.items():
            ages, used = one["ages"][phase], statistics.fmean(one["mbit"][phase])
            rate = len(ages) / options.seconds / options.rounds
            p95 = quantile(ages, 0.95)
            lines.append(
                f"| {phase} | {way} | {rate:.1f} | {statistics.fmean(ages) * 1e3:.0f} "
                f"| {p95 * 1e3:.0f} | {max(ages) * 1e3:.0f} | {p95 / free:.1f} "
                f"| {used / (LOW if phase == '5' else HIGH):.0%} |"
            )
    return [*lines, "", f"Unloaded: {free * 1e3:.0f} ms, the median of the plain JPEG at 50."]


def quantile(values: list[float], part: float) -> float:
    return sorted(values)[min(int(len(values) * part), len(values) - 1)]


def plot(found: dict, path: Path, seconds: float) -> None:
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams["svg.hashsalt"] = "adaptive"
    figure, axes = plt.subplots(figsize=(7, 3.5))
    for way, one in found.items():
        course = one["course"][:: max(1, len(one["course"]) // 300)]  # a drawing, not an archive
        axes.plot([t for t, _ in course], [a * 1e3 for _, a in course], ".", ms=3, label=way)
    axes.axvspan(seconds, 2 * seconds, alpha=0.12, label="5 Mbit/s")
    axes.set(yscale="log", xlabel="s", ylabel="age of an image on arrival, ms")
    axes.grid(alpha=0.3, which="both")
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--as", dest="program", choices=PROGRAMS, help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=float, default=12.0, help="per speed of the link")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw it (needs matplotlib)")
    options = parser.parse_args()
    if options.program:
        PROGRAMS[options.program]()
        return 0
    with Idle() as idle, Hosts(__file__, HIGH) as hosts:
        found = measure(hosts, options)
    print("\n".join(table(found, options)))
    print(f"\nThe processors were idle for {idle.percent:.0f} % of the time.")
    if options.plot:
        plot(found, options.plot, options.seconds)
    return 0


if __name__ == "__main__":
    sys.exit(main())
