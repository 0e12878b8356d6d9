"""The tables of connections and ports."""

import pytest

from yarpy.cli.overview import (
    COLUMNS,
    PORTS,
    connections_json,
    layout,
    line,
    port_rows,
    ports_json,
    row,
    shown,
)
from yarpy.contact import Contact
from yarpy.network.traffic import End, Flow, PortState, Snapshot
from yarpy.qos import Qos

LONG = ("/robot/left_arm/very/long/name/state:o", "/logger/of/everything/left_arm/state:i", "tcp",
        "1234567", "1000.0", "81.25", "7", "12", "3", "0", "0", "0.10", "0.52", "FIFO 30", "AF42",
        "")  # fmt: skip


@pytest.mark.parametrize("width", [80, 100, 120, 40])
def test_narrow_terminals_lose_columns_and_no_letter_of_a_name(width):
    lines = ["  ".join(text for text, _ in cells) for cells in layout([LONG], width, False)]
    assert LONG[0] in lines[1] and LONG[1] in lines[1]
    assert lines[0].rstrip().endswith("drops" if width < 100 else lines[0].split("  ")[-1])
    assert max(map(len, lines)) <= max(width, len("  ".join([*LONG[:2], "drops"])))


def test_wide_shows_everything():
    [titles, cells] = layout([LONG], 80, True)
    assert [text.strip() for text, _ in cells] == list(LONG)
    assert len(titles) == len(COLUMNS)


def test_a_connection_in_all_columns():
    sender = End("tcp", 10, 1000, drops=1, unconfirmed=0, latency=0.002)
    sender.qos, sender.monitors, sender.parameters = Qos(packets="HIGH"), ["m"], {"level": 3}
    receiver = End("tcp", 10, 1000, drops=2, timing={"missed": 7}, qos=Qos("FIFO", 30, "NORM"))
    found = row(Flow("/a", "/b", sender, receiver, 5.0, 2e6))
    assert found == (
        "/a", "/b", "tcp", "10", "5.0", "2.00", "", "3", "7", "0", "", "", "2.00", "- / FIFO 30",
        "AF42 / CS0", "m (level=3)",
    )  # fmt: skip


def test_names_of_strangers_are_made_readable():
    [_, cells] = layout([("/a\x1b[2J", *LONG[1:])], None, False)
    assert line(cells).startswith("/a\\x1b[2J")


def snapshot() -> Snapshot:
    found = Snapshot(5.0)
    for name in ("/a", "/b", "/dead"):
        found.ports[name] = PortState(name, Contact("tcp", name, "host", 1), "answers", pid=7)
    found.ports["/dead"].state = "refused"
    found.ports["/a"].answer_time = 0.0015
    found.flows["/a", "/b"] = Flow(
        "/a", "/b", End("tcp", 5, drops=2), End("tcp", 5, waiting=3), 9.5
    )
    found.flows["/a", ""] = Flow("/a", "", End(unconnected=4))
    return found


def test_ports_and_what_goes_through_them():
    rows = port_rows(snapshot(), snapshot().ports.values())
    assert rows[0] == ("/a", "answers", "0", "1", "", "9.5", "", "2", "1.5", "host", "7", "")
    assert rows[1][2:7] == ("1", "0", "9.5", "", "3")
    assert rows[2][:4] == ("/dead", "refused", "", "")
    assert len(rows[0]) == len(PORTS)


def test_all_of_it_for_programs():
    [one, past] = connections_json(snapshot())
    assert (one["source"], one["messages_per_second"], one["drops"]) == ("/a", 9.5, 2)
    assert past["sender"]["unconnected"] == 4
    assert [flow.target for flow in shown(snapshot(), False)] == ["/b"]
    assert ports_json(snapshot())[2]["state"] == "refused"
