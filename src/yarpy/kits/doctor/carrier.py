"""Findings about carriers: one that loses what it should carry, or cannot carry it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor import process
from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.finding import Finding
from yarpy.wire.datagram import MAX_DATAGRAM

DATAGRAMS: Final = ("udp", "mcast")
TEXTS: Final = ("text", "text_ack")
LONG_TEXT: Final = 100_000  # bytes of a message for which text is the wrong carrier
NUMBERS: Final = ("Image", "Sound", "Matrix", "Vector", "PointCloud", "ndarray")


def find(case: Case) -> Iterator[Finding]:
    """lost-datagrams, nothing-arrives, text-of-images."""
    for pair in case.pairs:
        if pair.carrier in DATAGRAMS:
            yield from _datagrams(case, pair)
        elif pair.carrier in TEXTS:
            yield from _text(case, pair)


def _datagrams(case: Case, pair: Pair) -> Iterator[Finding]:
    written, came = pair.grown("sender", "messages"), pair.grown("receiver", "messages")
    lost, size = pair.grown("receiver", "lost"), _size(pair)
    better = f"`yarpy connect {pair.source} {pair.target} tcp`"
    if lost:
        pieces = max(1, -(-size // MAX_DATAGRAM))
        yield Finding(
            "lost-datagrams",
            pair.name,
            f"{lost} messages were lost on the way over {pair.carrier} in {case.seconds:.1f} s, "
            f"{came or 0} arrived; a message of {size} bytes takes {pieces} datagrams, and is lost "
            f'with any of them, or if it is larger than "{pair.target}" takes',
            f"{better}; or larger buffers on the receiver's computer: `sudo sysctl -w "
            "net.core.rmem_max=8388608`",
            "warning" if came else "fault",
        )
    elif written and came == 0:
        kind = "messages to the multicast group" if pair.carrier == "mcast" else "datagrams"
        why = (
            "there is no route for multicast between the two, or a switch or Wi-Fi does not pass "
            "it on"
            if pair.carrier == "mcast"
            else "a firewall is in between, or the receiver listens in another network"
        )
        yield Finding(
            "nothing-arrives",
            pair.name,
            f'"{pair.source}" sent {written} messages over {pair.carrier} in {case.seconds:.1f} s, '
            f'and none arrived at "{pair.target}": {kind} do not get there ({why})',
            better + ("" if pair.carrier == "udp" else "; `ip maddr` lists the groups joined"),
        )
    most = process.setting("net/core/rmem_max") if case.is_here(pair.target) else None
    if most is not None and size > most:
        yield Finding(
            "small-buffers",
            pair.name,
            f"a message of {size} bytes does not fit into the {most} bytes that this system gives "
            "a socket to receive datagrams (net.core.rmem_max)",
            f"`sudo sysctl -w net.core.rmem_max=8388608`, or {better}",
            "warning",
        )


def _text(case: Case, pair: Pair) -> Iterator[Finding]:
    seen = case.peek(pair.source)
    if seen.kind == "Image" or (seen.size > LONG_TEXT and seen.kind in NUMBERS):
        yield Finding(
            "text-of-images",
            pair.name,
            f'"{pair.source}" sends {seen.kind} of {seen.size} bytes, which {pair.carrier} spells '
            "as text, number by number: several times the bytes, and hardly any reader takes it "
            "for what it was",
            f"`yarpy connect {pair.source} {pair.target} tcp`",
        )


def _size(pair: Pair) -> int:
    """Bytes of a message, on average."""
    if pair.now is None:
        return 0
    messages, size = pair.now.measured("messages"), pair.now.measured("bytes")
    sender = pair.now.sender
    if sender is not None and sender.messages and sender.bytes:
        messages, size = sender.messages, sender.bytes
    return int(size / messages) if messages and size else 0
