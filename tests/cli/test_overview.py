"""`yarpy stats` without a port: every connection of the network."""

import json
import re
import signal

import pytest
from support.wait import wait_until

import yarpy
from yarpy.cli.overview import COLUMNS, layout


@pytest.fixture(scope="module")
def ports(names):
    with (
        yarpy.Port("/over/in", names=names) as in_,
        yarpy.BufferedPort("/over/[bold]out", names=names) as out,
    ):
        out.connect("/over/in")
        out.outputs[0].qos = yarpy.Qos(packets="HIGH")
        for number in range(5):
            wait_until(lambda number=number: out.write([number]))
            in_.read(timeout=5)
        yield out, in_


def test_lines(here, ports):
    lines = here("stats", "--wide").out.splitlines()
    assert lines[0].split()[:4] == ["from", "to", "carrier", "messages"]
    [line] = [line for line in lines if "/over/in" in line]
    assert re.match(r"/over/\[bold\]out +/over/in +tcp +5 ", line)
    assert "AF42 / CS0" in line


def test_few_columns_by_default_and_numbers_aligned(here, ports):
    lines = here("stats").out.splitlines()
    assert lines[0].split("  ")[0] == "from"
    assert re.split(r"  +", lines[0]) == ["from", "to", "carrier", "msg/s", "MB/s", "drops",
                                          "latency ms"]  # fmt: skip
    end = lines[0].index("drops") + len("drops")
    assert [line[:end].split()[-1].isdigit() for line in lines[1:]] == [True] * len(lines[1:])
    assert all(line[end : end + 1] in ("", " ") for line in lines[1:])


LONG = ("/robot/left_arm/very/long/name/state:o", "/logger/of/everything/left_arm/state:i", "tcp",
        "1234567", "1000.0", "81.25", "12", "3", "0", "0", "0.10", "0.52", "FIFO 30", "AF42",
        "")  # fmt: skip


@pytest.mark.parametrize("width", [80, 100, 120, 40])
def test_narrow_terminals_lose_columns_and_no_letter_of_a_name(width):
    lines = ["  ".join(text for text, _ in cells) for cells in layout([LONG], width, False)]
    assert LONG[0] in lines[1] and LONG[1] in lines[1]
    assert lines[0].rstrip().endswith("drops" if width < 100 else lines[0].split("  ")[-1])
    assert max(map(len, lines)) <= max(width, len("  ".join([*LONG[:2], "drops"])))


def test_wide_shows_everything():
    [titles, row] = layout([LONG], 80, True)
    assert [text.strip() for text, _ in row] == list(LONG)
    assert len(titles) == len(COLUMNS)


def test_what_is_written_to_nobody_is_no_trouble(here, ports):
    with yarpy.Port("/over/idle") as idle:
        idle.write(["nobody"])
        assert "/over/idle" not in here("stats").out
        lines = here("stats", "--wide").out.splitlines()
    [line] = [line for line in lines if "/over/idle" in line]
    assert line.split()[:5] == ["/over/idle", "(past)", "0", "0", "0"]
    assert "1" in line.split()


def test_json(here, ports):
    [flow] = [one for one in json.loads(here("stats", "--json").out) if one["target"] == "/over/in"]
    assert (flow["source"], flow["carrier"]) == ("/over/[bold]out", "tcp")
    assert flow["sender"]["messages"] == flow["receiver"]["messages"] == 5
    assert flow["sender"]["qos"]["packets"] == "AF42"


def test_watching_ends_with_a_signal(cli, ports):
    with cli.start("stats", "--watch", "--json") as process:
        process.wait_line(r"^\[", stream="out", count=2)
        process.signal(signal.SIGINT)
        assert process.wait() == 0


def test_table_on_a_terminal():
    """Names are shown as they are, brackets included; drops stand out."""
    import io

    from rich.console import Console

    from yarpy.cli.overview import Overview, _text
    from yarpy.network.traffic import End, Flow

    overview = Overview()
    overview.flows = [
        Flow("/[bold]a", "/b", End("tcp", 5, 100, 2, rate=10.0), End("tcp", 5, 100, 1), 10.0)
    ]
    out = io.StringIO()
    Console(file=out, width=200, force_terminal=True, color_system="standard").print(
        _text(overview, 200, False)
    )
    assert "/[bold]a" in out.getvalue()
    assert "\x1b[1;31m    3\x1b[0m" in out.getvalue()
