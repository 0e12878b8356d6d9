"""The experiment of docs/qos.md: what priorities do for a control loop on a crowded network.

Three hosts (network namespaces, so this needs root and iproute2): a publisher, a subscriber, and a
switch between them whose two links are shaped (tbf, with pfifo_fast inside). A loop of 100 Hz sends
100 bytes there and back; beside it images fill the link in both directions, and busy processes the
processors. The same running programs are measured with nothing set, with thread priorities, with
packet priorities, and with both, in turns; what is set is set from outside, as `yarpy qos` and
`yarpy sched` do it.

    sudo .venv/bin/python bench/qos.py [--seconds 8] [--rounds 3] [--mbit 50] [--plot FILE.svg]
"""

import argparse
import json
import os
import statistics
import sys
import threading
import time
from pathlib import Path

from hosts import Hosts, ask, hogs, say, serve_names

import yarpy
from yarpy.network import qos as remote

LOOP = 100.0  # Hz
PAYLOAD = "x" * 80  # with the number and the headers of a Bottle about 100 bytes
THREAD = yarpy.Qos("SCHED_FIFO", 30)
PACKETS = yarpy.Qos(packets="HIGH")
BOTH = yarpy.Qos("SCHED_FIFO", 30, "HIGH")
NOTHING = yarpy.Qos("SCHED_OTHER", 0, "NORM")
CONDITIONS = {
    "unloaded": NOTHING,
    "nothing set": NOTHING,
    "threads": yarpy.Qos("SCHED_FIFO", 30, "NORM"),
    "packets": yarpy.Qos("SCHED_OTHER", 0, "HIGH"),
    "both": BOTH,
}
CONTROL = (("/control/out", "/echo/in"), ("/echo/out", "/control/back"))
BULK = (("/bulk/pub/out", "/bulk/sub/in"), ("/bulk/sub/out", "/bulk/pub/in"))


# -- the programs: they know nothing of priorities ------------------------------------------------


def control() -> None:
    """Sends, and notes when the echo comes. Each line it reads is for how many seconds."""
    sent: dict[int, float] = {}
    trips: dict[int, float] = {}

    def back(message: yarpy.Message) -> None:
        number = message.value[0]
        trips[number] = time.perf_counter() - sent[number]

    with (
        yarpy.Port("/control/out") as out,
        yarpy.BufferedPort("/control/back", callback=back),
    ):
        print("ready", flush=True)
        number = 0
        for line in sys.stdin:
            count = int(float(line) * LOOP)
            first, due = number, time.perf_counter()
            for _ in range(count):
                due += 1 / LOOP
                time.sleep(max(0.0, due - time.perf_counter()))
                sent[number] = time.perf_counter()
                out.write([number, PAYLOAD], yarpy.Stamp(number, time.time()))
                number += 1
            time.sleep(1.0)  # the last ones may still be on their way
            came = [n for n in range(first, number) if n in trips]
            found = {"trips": [trips[n] for n in came], "at": [(n - first) / LOOP for n in came]}
            print(json.dumps({"sent": count, **found}), flush=True)


def echo() -> None:
    """Sends back what comes, with a stamp of its own."""

    def answer(message: yarpy.Message) -> None:
        out.write(message.value, yarpy.Stamp(message.value[0], time.time()))

    with yarpy.Port("/echo/out") as out, yarpy.BufferedPort("/echo/in", callback=answer):
        print("ready", flush=True)
        sys.stdin.read()


def bulk(host: str) -> None:
    """Sends images as fast as the link takes them, to whoever is connected, and counts others'."""
    import numpy as np

    image = yarpy.Image(np.random.default_rng(1).integers(0, 255, (480, 640, 3), "u1"))
    came = [0]

    def count(message: yarpy.Message) -> None:
        came[0] += len(message.payload)

    def send() -> None:
        while True:
            if not out.write(image):
                time.sleep(0.05)

    with (
        yarpy.Port(f"/bulk/{host}/out") as out,
        yarpy.BufferedPort(f"/bulk/{host}/in", callback=count),
    ):
        print("ready", flush=True)
        threading.Thread(target=send, daemon=True).start()
        for _ in sys.stdin:
            print(came[0], flush=True)


PROGRAMS = {
    "names": serve_names,
    "control": control,
    "echo": echo,
    "bulk-pub": lambda: bulk("pub"),
    "bulk-sub": lambda: bulk("sub"),
}

# -- the experiment -------------------------------------------------------------------------------


def measure(hosts: Hosts, options: argparse.Namespace) -> dict[str, dict]:
    hosts.start("switch", "names")
    loop = hosts.start("pub", "control")
    hosts.start("sub", "echo")
    ends = [hosts.start(host, f"bulk-{host}") for host in ("pub", "sub")]
    found = {name: {"trips": [], "sent": 0, "bulk": []} for name in CONDITIONS}
    with hosts.entered():
        for source, target in CONTROL:
            yarpy.connect(source, target)
        for number in range(options.rounds):
            for name in rotated(CONDITIONS, number):
                say(f"round {number + 1} of {options.rounds}: {name}")
                loaded = name != "unloaded"
                for source, target in CONTROL:
                    qos = CONDITIONS[name]
                    remote.grant(source, target, sender=qos, receiver=qos)
                with hogs(2 * (os.cpu_count() or 1) if loaded else 0):
                    for source, target in BULK:
                        (yarpy.connect if loaded else yarpy.disconnect)(source, target)
                    ask(loop, 2)  # let it settle
                    before, began = [int(ask(one, "")) for one in ends], time.monotonic()
                    answer = json.loads(ask(loop, options.seconds))
                    passed = time.monotonic() - began
                    after = [int(ask(one, "")) for one in ends]
                found[name]["trips"] += answer["trips"]
                found[name]["sent"] += answer["sent"]
                moved = sum(after) - sum(before)
                found[name]["bulk"].append(moved * 8e-6 / passed)
    return found


def rotated(names, by: int) -> list[str]:
    order = [*names]
    by %= len(order)
    return order[by:] + order[:by]


def summary(found: dict[str, dict]) -> dict[str, dict]:
    rows = {}
    for name, one in found.items():
        trips = sorted(one["trips"])
        changes = [abs(b - a) for a, b in zip(one["trips"], one["trips"][1:], strict=False)]
        rows[name] = {
            "mean": statistics.fmean(trips) * 1e3,
            "p99": trips[int(len(trips) * 0.99)] * 1e3,
            "jitter": statistics.fmean(changes) * 1e3,
            "lost": one["sent"] - len(trips),
            "bulk": statistics.fmean(one["bulk"]),
        }
    return rows


def table(rows: dict[str, dict]) -> list[str]:
    free, none = rows["unloaded"], rows["nothing set"]
    lines = [
        "| | mean ms | 99 % ms | jitter ms | x unloaded | mean | jitter | bulk Mbit/s | lost |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for name, row in rows.items():
        change = ["", ""]
        if name not in ("unloaded", "nothing set"):
            change = [f"{row[key] / none[key] - 1:+.0%}" for key in ("mean", "jitter")]
        lines.append(
            f"| {name} | {row['mean']:.2f} | {row['p99']:.2f} | {row['jitter']:.2f} "
            f"| {row['mean'] / free['mean']:.1f} | {change[0]} | {change[1]} "
            f"| {row['bulk']:.0f} | {row['lost']} |"
        )
    return lines


def plot(found: dict[str, dict], path: Path) -> None:
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams["svg.hashsalt"] = "qos"
    figure, axes = plt.subplots(figsize=(7, 4))
    for name, one in found.items():
        trips = sorted(one["trips"])
        share = [(n + 1) / len(trips) * 100 for n in range(len(trips))]
        step = max(1, len(trips) // 400)  # a drawing, not an archive
        axes.plot([t * 1e3 for t in trips[::step]], share[::step], label=name)
    axes.set(xscale="log", xlabel="round trip, ms", ylabel="part of the messages, %")
    axes.grid(alpha=0.3, which="both")
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--as", dest="program", choices=PROGRAMS, help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=float, default=8.0, help="per condition and round")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--mbit", type=float, default=50.0, help="of each link")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw it (needs matplotlib)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers")
    options = parser.parse_args()
    if options.program:
        PROGRAMS[options.program]()
        return 0
    with Hosts(__file__, options.mbit) as hosts:
        found = measure(hosts, options)
    print("\n".join(table(summary(found))))
    if options.json:
        options.json.write_text(json.dumps(summary(found), indent=1))
    if options.plot:
        plot(found, options.plot)
    return 0


if __name__ == "__main__":
    sys.exit(main())
