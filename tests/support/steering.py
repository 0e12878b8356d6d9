"""A made-up network: flows with counters that a test turns, as snapshots."""

from __future__ import annotations

from typing import Any

from yarpy.contact import parse_contact
from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.governor import Governor
from yarpy.kits.autoqos.rules import parse
from yarpy.network.traffic import End, Flow, PortState, Snapshot
from yarpy.qos import Qos

LOOP = ("/control", "/motors")
BULK = ("/cam", "/viewer")
RULES = """
[[critical]]
connections = ["/control -> /motors"]
deadline = 0.01

[[best-effort]]
connections = ["/cam"]
least = 2.0
"""


class Network:
    """A control loop of 100 Hz and a camera. `late` says which part of the loop's messages is."""

    def __init__(self, rules: str = RULES, trusting: bool = False) -> None:
        self.governor = Governor(parse(rules), trusting)
        self.now = 1000.0
        self.rates = {LOOP: 100.0, BULK: 30.0}
        self.mbit = {LOOP: 0.1, BULK: 40.0}
        self.held_up = {BULK}
        self.counts = True
        self.ours = True
        self.settings: dict[tuple[str, str, str], Any] = {}
        self.counters: dict[tuple[str, str], list[float]] = {}
        self.refuses: dict[str, str] = {}
        self.steps: list[str] = []
        self.silent: set[str] = set()

    def late(self) -> float:
        """To be replaced by a test."""
        return 0.0

    def has(self, key: str, pair: tuple[str, str] = LOOP) -> bool:
        """Whether a setting of the sender is in force."""
        return (*pair, key) in self.settings

    def snapshot(self) -> Snapshot:
        found = Snapshot(self.now)
        for pair in self.rates:
            messages, size, missed = self.counters.setdefault(pair, [0.0, 0.0, 0.0])
            timing = {"missed": int(missed)} if (*pair[::-1], "timing") in self.settings else {}
            known = self.counts or pair != LOOP
            counted: dict[str, Any] = (
                {"messages": int(messages), "bytes": int(size), "drops": 0} if known else {}
            )
            ends = []
            for port, peer in (pair, pair[::-1]):
                policy, priority = self.settings.get((port, peer, "threads"), ("SCHED_OTHER", 0))
                packets = self.settings.get((port, peer, "packets"), "CS0")
                carrier = self.settings.get((*pair, "carrier"), "tcp")
                qos = Qos(policy, priority, packets)
                ends.append(End(carrier, qos=qos, **counted))
                state = PortState(port, parse_contact(port), "answers", ours=self.ours)
                found.ports[port] = state
            sender, receiver = ends
            sender.unacknowledged = int(pair in self.held_up)
            receiver.timing = timing if known else {}
            if (pair[0], pair[0], "limit") in self.settings:
                sender.dropped = {"Adaptive of the port": 0}
            speed = self.mbit[pair] * 125_000 if known else None
            flow = Flow(*pair, sender, receiver, self.rates[pair], speed)
            flow.sender = None if pair[0] in self.silent else sender
            flow.receiver = None if pair[1] in self.silent else receiver
            found.flows[pair] = flow
        return found

    def run(self, seconds: float, period: float = 0.25) -> list[str]:
        """Let time pass; the steps that were taken, as they were told."""
        told, end = [], self.now + seconds
        while self.now < end:
            self.now += period
            for pair, counter in self.counters.items():
                counter[0] += self.rates[pair] * period
                counter[1] += self.mbit[pair] * 125_000 * period
                if pair == LOOP:
                    counter[2] += self.rates[pair] * period * self.late()
            step = self.governor.decide(self.snapshot(), self.now)
            if step is None:
                continue
            failed = {one: self.refuses[one.key] for one in step.changes if one.key in self.refuses}
            for change in step.changes:
                if change not in failed:
                    self.make(change)
            self.governor.done(step, failed, self.now)
            told.append(step.why)
        self.steps += told
        return told

    def make(self, change: Change) -> None:
        if change.value in (change.before, None, "CS0", ("SCHED_OTHER", 0), "tcp"):
            self.settings.pop(change.what, None)
        else:
            self.settings[change.what] = change.value
