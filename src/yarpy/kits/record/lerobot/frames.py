"""Frames: what each port had said last, at even distances in time.

Rules: an episode begins when every port has spoken and ends with the first one that is silent for
good. Each frame has of every port the newest message that had come by then, as imitation learning
sees a robot; nothing is interpolated. The order of receipt counts, which all ports share.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording


def stretch(recording: Recording, ports: Collection[str]) -> tuple[int, int]:
    """Return when an episode begins and ends, in nanoseconds. Raises UnknownName;
    LocalProtocolError for ports that do not speak at one time."""
    begins: dict[str, int] = {}
    ends: dict[str, int] = {}
    for recorded in recording.messages(ports):
        begins.setdefault(recorded.port, recorded.received_ns)
        ends[recorded.port] = recorded.received_ns
    for port in ports:
        if port not in begins:
            raise LocalProtocolError(f'"{port}" said nothing: there is no episode')
    begin, end = max(begins.values()), min(ends.values())
    if begin > end:
        late, early = max(begins, key=begins.__getitem__), min(ends, key=ends.__getitem__)
        raise LocalProtocolError(
            f'"{late}" begins when "{early}" is over: an episode has all of its ports at one time'
        )
    return begin, end


def count(begin: int, end: int, fps: int) -> int:
    """Return how many frames are between these moments, in nanoseconds."""
    return (end - begin) * fps // SECOND + 1


def frames(
    recording: Recording, ports: Collection[str], fps: int, begin: int, end: int
) -> Iterator[dict[str, Recorded]]:
    """Yield the last message of each port, `fps` times a second."""
    total, number = count(begin, end, fps), 0
    last: dict[str, Recorded] = {}
    for recorded in recording.between(ports, 0, end + 1):
        while number < total and recorded.received_ns > begin + number * SECOND // fps:
            yield dict(last)
            number += 1
        last[recorded.port] = recorded
    for _ in range(number, total):
        yield dict(last)
