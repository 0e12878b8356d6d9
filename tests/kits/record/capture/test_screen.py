"""The table of a recorder that runs."""

from dataclasses import replace

import pytest

from yarpy.kits.record.capture.queue import Count
from yarpy.kits.record.capture.screen import Rates, Status, clock, cut, ordered, summary, text

LOOK = Status(
    file="walk.mcap",
    seconds=75.2,
    size=12_345_678,
    held=64,
    memory=256,
    free=5_000_000_000,
    paused=False,
    counts={
        "/icub/head/state:o": Count(messages=7500, bytes=300_000),
        "/icub/cam/left": Count(messages=2000, bytes=12_000_000, lost=7, missed=3),
        "/icub/old": Count(messages=1, bytes=10),
    },
    rates={"/icub/head/state:o": 100.02, "/icub/cam/left": 29.97},
    connected={"/icub/head/state:o", "/icub/cam/left", "/icub/silent"},
    waiting=["/icub/late"],
)


def test_what_loses_comes_first() -> None:
    names = [name for name, _ in ordered(LOOK)]
    assert names[:2] == ["/icub/cam/left", "/icub/late"]
    assert names[2:] == ["/icub/head/state:o", "/icub/old", "/icub/silent"]


def test_the_whole_screen() -> None:
    lines = text(LOOK, 80, 24).plain.splitlines()
    assert lines[0] == "recording 0:01:15  walk.mcap"
    assert lines[1].startswith("9501 messages, 12.3 MB | 7 lost | 5 GB left on the disk | 25 %")
    assert lines[2].split() == [
        "port",
        "msg/s",
        "messages",
        "size",
        "lost",
        "missed",
        "left",
        "out",
    ]
    found = {line.split()[0]: line.split()[1:] for line in lines[3:8]}
    assert found["/icub/cam/left"] == ["30.0", "2000", "12", "MB", "7", "3", "0"]
    assert found["/icub/head/state:o"][:2] == ["100", "7500"]
    assert found["/icub/old"][0] == "gone"
    assert found["/icub/late"] == ["not", "there"] and found["/icub/silent"] == ["silent"]
    assert "space pause" in lines[-1]


@pytest.mark.parametrize(("width", "height"), [(20, 4), (40, 8), (80, 24), (200, 60)])
def test_it_fits_every_screen(width: int, height: int) -> None:
    crowd = {f"/a/very/long/name/of/a/port/{n}": Count(messages=n) for n in range(100)}
    status = replace(LOOK, counts=crowd, connected=set(crowd), news="x" * 300)
    lines = text(status, width, height).plain.splitlines()
    assert all(len(line) <= width for line in lines)
    assert len(lines) <= max(height, 6)
    if height < 60:
        assert "more ports" in lines[-1] or width == 20


def test_what_ports_send_cannot_move_the_cursor() -> None:
    status = replace(LOOK, counts={"/a\x1b[2J": Count(messages=1)}, news="\x1b]0;x\x07")
    assert "\x1b" not in text(status, 80, 24).plain
    assert "\x1b" not in "".join(summary(status))


def test_rates() -> None:
    rates, count = Rates(), Count(messages=10)
    assert rates.take({"/a": count}, 5.0) == {"/a": 0.0}
    count.messages = 30
    assert rates.take({"/a": count}, 7.0) == {"/a": 10.0}
    assert rates.take({"/a": count}, 7.0) == {}


def test_the_end() -> None:
    assert summary(LOOK) == [
        "walk.mcap: 0:01:15, 9501 messages, 12.3 MB",
        "  /icub/cam/left: 2000 (7 lost, 3 never arrived)",
        "  /icub/head/state:o: 7500",
        "  /icub/old: 1",
    ]


def test_short_names_and_times() -> None:
    assert cut("/icub/left_arm/state:o", 12) == "/icub…tate:o"
    assert cut("/short", 12) == "/short"
    assert clock(3600 * 30 + 61) == "30:01:01"
