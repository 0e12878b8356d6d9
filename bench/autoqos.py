"""The other experiments of docs/qos.md: priorities set by `yarpy autoqos`, and who does not starve.

The hosts and programs are those of bench/qos.py. `control`: the loop of 100 Hz beside images in
both directions and busy processes, with nothing set, set by hand, and by the agent, which is
started before the load. `starvation`: a critical stream floods the link with the highest priority,
beside a best-effort one with a stated minimum, without the agent and with it.

    sudo .venv/bin/python bench/autoqos.py [control | starvation] [--plot FILE.svg]
"""

import argparse
import contextlib
import json
import os
import signal
import statistics
import sys
import tempfile
import threading
import time
from pathlib import Path

from hosts import Hosts, Idle, ask, hogs, say
from qos import BOTH, BULK, CONTROL, NOTHING, PROGRAMS

import yarpy
from yarpy.network import qos

DEADLINE = 0.01  # seconds, of each way of the loop
TRIP = 2 * DEADLINE
LEAST = 5.0  # Mbit/s that the best-effort stream keeps
RULES = f"""
[[critical]]
connections = ["/control/*", "/echo/*"]
deadline = {DEADLINE}

[[best-effort]]
connections = ["/bulk/*"]
least = {LEAST}
"""
FLOOD = """
[[critical]]
connections = ["/bulk/pub/out"]
deadline = 10.0

[[best-effort]]
connections = ["/small/*"]
least = 5.0
"""
SMALL = "/small/out", "/small/in"


def small_out() -> None:
    """Sends 10 kB as fast as it can."""
    with yarpy.Port(SMALL[0]) as out:
        print("ready", flush=True)
        while True:
            if not out.write(b"x" * 10_000):
                time.sleep(0.05)


def small_in() -> None:
    """Says how many bytes came."""
    came = [0]

    def count(message: yarpy.Message) -> None:
        came[0] += len(message.payload)

    with yarpy.BufferedPort(SMALL[1], callback=count):
        print("ready", flush=True)
        for _ in sys.stdin:
            print(came[0], flush=True)


class Steered:
    """`yarpy autoqos` on the switch; `events` is what it said, with the time of each."""

    def __init__(self, hosts: Hosts, rules: str) -> None:
        self._folder = tempfile.TemporaryDirectory()
        file = Path(self._folder.name, "rules.toml")
        file.write_text(rules, encoding="utf-8")
        os.environ["YARP_DATA_HOME"] = self._folder.name
        words = (sys.executable, "-m", "yarpy", "autoqos", str(file), "--json")
        self._process = hosts.spawn("switch", *words)
        self.events: list[dict] = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in self._process.stdout:
            event = json.loads(line)
            self.events.append(event)
            failed = "".join(f"\n      refused: {one['error']}" for one in event["failed"])
            say(f"    {event['text']}{failed}")

    def changes(self, since: float) -> int:
        """Steps that changed something after a time."""
        return sum(bool(e["changes"]) for e in self.events if e["time"] >= since)

    def end(self) -> None:
        self._process.send_signal(signal.SIGINT)
        self._process.wait(30)
        self._folder.cleanup()


# -- the loop -------------------------------------------------------------------------------------


def control(hosts: Hosts, options: argparse.Namespace) -> list[str]:
    hosts.start("switch", "names")
    loop = hosts.start("pub", "control")
    hosts.start("sub", "echo")
    ends = [hosts.start(host, f"bulk-{host}") for host in ("pub", "sub")]
    rows: dict[str, list[dict]] = {}
    with hosts.entered():
        for source, target in CONTROL:
            yarpy.connect(source, target)
        for number in range(options.rounds):
            for name in ("unloaded", "nothing set", "by hand", "automatic"):
                say(f"round {number + 1} of {options.rounds}: {name}")
                given = BOTH if name == "by hand" else NOTHING
                for source, target in CONTROL:
                    qos.grant(source, target, sender=given, receiver=given)
                agent = Steered(hosts, RULES) if name == "automatic" else None
                if agent is not None:
                    time.sleep(3)
                rows.setdefault(name, []).append(loaded(loop, ends, name, agent, options))
                if agent is not None:
                    agent.end()
    if options.plot:
        plot_course({name: found[0]["course"] for name, found in rows.items()}, options.plot)
    lines = [
        "| | mean ms | 99 % ms | jitter ms | later than 20 ms | gain | under control after "
        "| bulk Mbit/s | changes |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    means = {
        name: statistics.fmean(t for one in found for t in one["trips"])
        for name, found in rows.items()
    }
    whole = means["nothing set"] - means["by hand"]
    for name, found in rows.items():
        trips = sorted(t for one in found for t in one["trips"])
        jitter = statistics.fmean(
            abs(b - a)
            for one in found
            for a, b in zip(one["trips"], one["trips"][1:], strict=False)
        )
        gain = f"{(means['nothing set'] - means[name]) / whole:.0%}"
        after = ", ".join(f"{one['after']:.1f} s" for one in found if one["after"] is not None)
        lines.append(
            f"| {name} | {means[name] * 1e3:.2f} | {trips[int(len(trips) * 0.99)] * 1e3:.1f} "
            f"| {jitter * 1e3:.2f} | {sum(t > TRIP for t in trips) / len(trips):.1%} "
            f"| {gain if name in ('by hand', 'automatic') else ''} "
            f"| {after if name == 'automatic' else ''} "
            f"| {statistics.fmean(one['bulk'] for one in found):.0f} "
            f"| {', '.join(str(one['changes']) for one in found) if name == 'automatic' else ''} |"
        )
    return lines


def loaded(loop, ends, name: str, agent: Steered | None, options: argparse.Namespace) -> dict:
    """One condition. What is counted begins three seconds after the load; `after` is when the loop
    was under control: from then on, at most a twentieth of half a second is late."""
    load = name != "unloaded"
    with hogs(2 * (os.cpu_count() or 1) if load else 0):
        began = time.time()
        for source, target in BULK:
            (yarpy.connect if load else yarpy.disconnect)(source, target)
        first = json.loads(ask(loop, 3.0 + options.seconds))
        before, since = [int(ask(one, "")) for one in ends], time.monotonic()
        time.sleep(2)
        after = [int(ask(one, "")) for one in ends]
        bulk = (sum(after) - sum(before)) * 8e-6 / (time.monotonic() - since)
    for source, target in BULK:
        yarpy.disconnect(source, target)
    pairs = list(zip(first["at"], first["trips"], strict=True))
    late: dict[int, list[bool]] = {}
    for at, trip in pairs:
        late.setdefault(int(at / 0.5), []).append(trip > TRIP)
    bad = [window for window, found in late.items() if statistics.fmean(found) > 0.05]
    return {
        "trips": [trip for at, trip in pairs if at >= 3.0],
        "course": pairs,
        "after": (max(bad) + 1) * 0.5 if bad else 0.0,
        "bulk": bulk,
        "changes": agent.changes(began) if agent else 0,
    }


def plot_course(found: dict[str, list[tuple[float, float]]], path: Path) -> None:
    """Round trips of the first round, by the time since the load began."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams["svg.hashsalt"] = "autoqos"
    figure, axes = plt.subplots(figsize=(7, 3.5))
    for name, course in found.items():
        some = course[::4]  # a drawing, not an archive
        axes.plot([at for at, _ in some], [t * 1e3 for _, t in some], ".", ms=3, label=name)
    axes.set(yscale="log", xlabel="s since the load began", ylabel="round trip, ms")
    axes.grid(alpha=0.3, which="both")
    axes.legend(loc="upper right")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


# -- who does not starve --------------------------------------------------------------------------


def starvation(hosts: Hosts, options: argparse.Namespace) -> list[str]:
    hosts.start("switch", "names")
    flood = [hosts.start("pub", "bulk-pub"), hosts.start("sub", "bulk-sub")]
    hosts.start("pub", "small-out")
    small = hosts.start("sub", "small-in")
    lines = [
        "| | flood Mbit/s | best effort Mbit/s | share of its minimum | changes |",
        "|---|--:|--:|--:|--:|",
    ]
    flow = BULK[0]
    with hosts.entered():
        for name in ("nothing set", "flood HIGH, no agent", "flood HIGH, agent"):
            for pair in (SMALL, flow):
                yarpy.connect(*pair)
            level = yarpy.Qos(packets="NORM" if name == "nothing set" else "HIGH")
            agent = Steered(hosts, FLOOD) if name.endswith(", agent") else None
            time.sleep(3 if agent else 0)
            for side in ("receiver", "sender"):  # where it floods, nothing can even answer
                with contextlib.suppress(yarpy.Timeout):
                    qos.grant(*flow, **{side: level})
            began = time.time()
            time.sleep(10)
            before, since = [int(ask(one, "")) for one in (flood[1], small)], time.monotonic()
            time.sleep(options.seconds)
            after, passed = [int(ask(one, "")) for one in (flood[1], small)], time.monotonic()
            big, little = (
                (b - a) * 8e-6 / (passed - since) for a, b in zip(before, after, strict=True)
            )
            lines.append(
                f"| {name} | {big:.1f} | {little:.2f} | {little / LEAST:.0%} "
                f"| {agent.changes(began) if agent else ''} |"
            )
            say(lines[-1])
            hosts.shape(1000.0)  # else nobody hears that it is to end
            if agent is not None:
                agent.end()
            for pair in (flow, SMALL):
                yarpy.disconnect(*pair)
            hosts.shape(options.mbit)
    return lines


PROGRAMS = {**PROGRAMS, "small-out": small_out, "small-in": small_in}
EXPERIMENTS = {"control": control, "starvation": starvation}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("experiment", nargs="?", choices=EXPERIMENTS, help="both without")
    parser.add_argument("--as", dest="program", choices=PROGRAMS, help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=float, default=10.0, help="per condition and round")
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw `control` (matplotlib)")
    parser.add_argument("--mbit", type=float, default=50.0, help="of each link")
    options = parser.parse_args()
    if options.program:
        PROGRAMS[options.program]()
        return 0
    for name in [options.experiment] if options.experiment else EXPERIMENTS:
        with Idle() as idle, Hosts(__file__, options.mbit) as hosts:
            lines = EXPERIMENTS[name](hosts, options)
        print("\n".join(lines))
        print(f"\nThe processors were idle for {idle.percent:.0f} % of the time.\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
