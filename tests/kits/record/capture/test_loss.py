"""What is lost is told once, and is in each file that it belongs to."""

import json
from typing import Any

from yarpy.kits.record.capture.loss import Losses
from yarpy.kits.record.capture.queue import Count


def test_losses_are_told_once() -> None:
    count = Count(lost=2, missed=1)
    losses = Losses({"/a": count, "/b": Count()})
    notes: list[dict[str, Any]] = []
    told: list[str] = []
    for _ in range(2):
        losses.tell(lambda what, now: notes.append({**what, "now": now}), told.append, 7)
    assert notes == [{"what": "lost", "port": "/a", "count": 2, "missed": 1, "now": 7}]
    (line,) = told
    assert line.startswith("2 messages of /a were lost: the disk is too slow, ")
    count.missed = 4
    losses.tell(lambda what, now: notes.append({**what, "now": now}), told.append, 8)
    assert (notes[1]["count"], notes[1]["missed"]) == (0, 3) and len(told) == 1
    count.replaced = 6
    losses.tell(lambda what, now: notes.append({**what, "now": now}), told.append, 9)
    assert notes[2]["replaced"] == 6 and len(notes) == 3


def test_each_file_has_its_own() -> None:
    count = Count(lost=2, left_out=5)
    losses = Losses({"/a": count})
    found = [{key: json.loads(value) for key, value in losses.of_file().items()}]
    count.lost = 3
    found += [{key: json.loads(value) for key, value in losses.of_file().items()}]
    assert found[0] == {"lost": {"/a": 2}, "missed": {}, "left out": {"/a": 5}, "replaced": {}}
    assert found[1] == {"lost": {"/a": 1}, "missed": {}, "left out": {}, "replaced": {}}
