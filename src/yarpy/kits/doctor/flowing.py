"""Findings about the flow of messages: nothing is written, nothing is read, somebody is held up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor import process
from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.connection import names_sender
from yarpy.kits.doctor.finding import Finding

MANY: Final = 0.1  # of all messages: fewer are dropped wherever a program is busy for a moment


def find(case: Case) -> Iterator[Finding]:
    """writes-nothing, never-reads, held-up, too-slow, late."""
    quiet: set[str] = set()  # senders that write nothing are named once
    for pair in case.pairs:
        if pair.before is None or not case.wanted or not _is_whole(case, pair):
            continue
        stuck = list(_receiver(case, pair))
        yield from stuck
        if not stuck:
            for finding in _sender(case, pair):
                if finding.probe != "writes-nothing" or pair.source not in quiet:
                    yield finding
                    quiet.add(pair.source)
            yield from _late(case, pair)


def _is_whole(case: Case, pair: Pair) -> bool:
    """Return whether both ends exist, as far as ports can be asked; otherwise that is the
    finding."""
    if pair.now is None:
        return False
    for name, end in ((pair.source, pair.now.sender), (pair.target, pair.now.receiver)):
        state = case.ports.get(name)
        if state is not None and state.state != "foreign" and end is None:
            return False
    return True


def _sender(case: Case, pair: Pair) -> Iterator[Finding]:
    written = pair.grown("sender", "messages")
    dropped = (pair.grown("sender", "replaced") or 0) + (pair.grown("sender", "drops") or 0)
    arrived = pair.grown("receiver", "messages")
    total = dropped + (written or 0)
    if dropped and dropped >= MANY * total and not _by_monitors(pair):
        yield Finding(
            "too-slow",
            pair.name,
            f'"{pair.source}" wrote {total} messages in {case.seconds:.1f} s and left out '
            f'{dropped} of them, since "{pair.target}" had not yet taken the one before',
            f'make "{pair.target}" faster, or let the connection send what it can take: `yarpy '
            f"connect {pair.source} {pair.target} {pair.carrier}+send.adaptive` (docs/monitors.md)",
            "warning" if written else "fault",
        )
        return
    if written or arrived or dropped or _answers(case, pair):
        return
    if written is None:
        seen = case.peek(pair.source)
        if seen.kind or seen.error:
            return  # it writes, as we have seen ourselves; or nobody knows
    sender = pair.end("sender")
    so_far = ""
    if sender is not None and sender.messages is not None:
        so_far = f"; over this connection it has written {sender.messages} so far"
    yield Finding(
        "writes-nothing",
        pair.name,
        f'the two are connected, and "{pair.source}" has written nothing for {case.seconds:.1f} s'
        f"{so_far}",
        f"look at the program of {pair.source}: it may wait for something itself (`yarpy doctor "
        f"{pair.source}` looks at what it reads); `yarpy read ... {pair.source}` shows what it "
        "writes",
    )


def _answers(case: Case, pair: Pair) -> bool:
    """Return whether questions travel on the connection: then it carries a message only now and
    then."""
    states = case.port(pair.source), case.port(pair.target)
    return any(state is not None and state.is_rpc for state in states)


def _late(case: Case, pair: Pair) -> Iterator[Finding]:
    """Deadlines that were missed between the looks."""
    old, new = (flow.missed if flow is not None else None for flow in (pair.before, pair.now))
    end = pair.end("receiver")
    if end is None or old is None or new is None or new <= old:
        return
    worst = end.timing.get("worst")
    beyond = f", by up to {worst * 1e3:.0f} ms" if isinstance(worst, float) else ""
    wanted = ", ".join(
        f"{key} {value:g} {unit}"
        for key, unit in (("deadline", "s"), ("rate", "Hz"))
        if isinstance(value := end.timing.get(key), int | float)
    )
    yield Finding(
        "late",
        pair.name,
        f'messages of "{pair.source}" came after their deadline {new - old} times in '
        f"{case.seconds:.1f} s ({wanted}){beyond}",
        f"give the connection priority: `yarpy qos set {pair.source} {pair.target} --src HIGH "
        f"--des HIGH`, `yarpy sched set {pair.source} {pair.target} --src FIFO:30 --des FIFO:30`; "
        "docs/qos.md says which of the two helps when",
        "warning",
    )


def _by_monitors(pair: Pair) -> bool:
    end = pair.end("sender")
    return end is not None and any(end.dropped.values())


def _receiver(case: Case, pair: Pair) -> Iterator[Finding]:
    """Yield a finding if the receiver does not take what arrives."""
    target = pair.target
    waiting, came = _waiting(pair), pair.grown("receiver", "messages")
    taken = _taken(case, target)
    if waiting and taken == 0:
        kept = (
            f"{waiting} messages wait there, and what comes is kept until memory is full"
            if waiting > 1
            else "one message waits there, and newer ones replace it or wait behind it"
        )
        yield Finding(
            "never-reads",
            pair.name,
            f'"{target}" gets messages and its program has not read any for {case.seconds:.1f} s; '
            f"{kept}",
            f"look at the program of {target}: it is busy, or waits for something else; "
            f"`yarpy read ... {pair.source}` shows what it would read",
        )
        return
    held = _held(pair) if names_sender(pair.carrier) else 0
    written = pair.grown("sender", "messages")
    if held and written == 0 and not came:
        yield Finding(
            "held-up",
            pair.name,
            f'"{pair.source}" waits: {held} messages are on their way to "{target}", which has not '
            f"confirmed any for {case.seconds:.1f} s (its program does not read, or its callback "
            "does not return)",
            f"look at the program of {target}; so that the sender does not wait for it, write from "
            "a BufferedPort, or connect over udp",
        )
        return
    state = case.port(target)
    if state is not None and state.ours is False and case.is_here(target):
        lying = process.unread(state.contact.port)
        if lying and not came:
            yield Finding(
                "never-reads",
                pair.name,
                f'{lying} bytes lie in front of "{target}", and its program does not read them',
                f"look at the program of {target}: it is busy, or waits for something else",
            )


def _waiting(pair: Pair) -> int:
    """Messages that wait for the receiver's program at both looks."""
    old = pair.before.receiver if pair.before is not None else None
    new = pair.end("receiver")
    counts = [end.waiting or 0 if end is not None else 0 for end in (old, new)]
    return counts[1] if all(counts) else 0


def _taken(case: Case, target: str) -> int | None:
    """Return how many messages of all its connections a program has taken between the looks."""
    total, waiting, known = 0, 0, False
    for (source, other), flow in case.now.flows.items():
        if other != target or flow.receiver is None:
            continue
        pair = case.pair(source, other)
        grown, more = pair.grown("receiver", "delivered"), pair.grown("receiver", "waiting")
        if grown is None or more is None:
            continue
        known, total, waiting = True, total + grown, more
    return total - waiting if known else None


def _held(pair: Pair) -> int:
    """Messages that were without an acknowledgement at both looks."""
    old = pair.before.sender if pair.before is not None else None
    new = pair.end("sender")
    counts = [end.unacknowledged or 0 if end is not None else 0 for end in (old, new)]
    return counts[1] if all(counts) else 0
