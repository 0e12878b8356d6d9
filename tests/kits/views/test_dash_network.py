"""dash_network: what changed is told once, numbers come in order, strangers' texts have a limit."""

from __future__ import annotations

import json
from typing import Any

from yarpy.contact import Contact
from yarpy.kits.views.dash_network import AT_ONCE, KEPT, View
from yarpy.network.traffic import End, Flow, PortState, Snapshot
from yarpy.qos import Qos


def snapshot(time: float, *names: str, flows: tuple[Flow, ...] = ()) -> Snapshot:
    found = Snapshot(time)
    for number, name in enumerate(names):
        contact = Contact("tcp", name, "127.0.0.1", 10002 + number)
        state = PortState(name, contact, "answers", program="python robot.py", pid=7, host="lab")
        found.ports[name] = state
    found.flows = {(flow.source, flow.target): flow for flow in flows}
    return found


def told(view: View, since: int = -1, event: int = 0) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(view.told(since, event, ""))
    return found


def test_before_the_first_look() -> None:
    assert told(View())["problem"] == "asking the ports ..."


def test_names_are_told_once() -> None:
    view = View()
    view.take(snapshot(1.0, "/a", "/b"))
    first = told(view)
    assert [port["name"] for port in first["ports"]] == ["/a", "/b"]
    assert first["ports"][0] == {
        "name": "/a",
        "address": ["127.0.0.1", 10002],
        "place": "lab",
        "program": "python robot.py",
        "process": 7,
        "ours": False,
        "image": False,
    }
    assert first["states"] == [[1, "alive"]] * 2
    assert first["problem"] == ""
    view.take(snapshot(2.0, "/a", "/b"))
    assert "ports" not in told(view, first["version"])
    view.take(snapshot(3.0, "/a"))
    assert [port["name"] for port in told(view, first["version"])["ports"]] == ["/a"]


def test_numbers_of_a_connection() -> None:
    def flow(drops: int) -> Flow:
        sender = End(
            "tcp", messages=100, drops=drops, jitter=0.0012345, qos=Qos("fifo", 30, "HIGH")
        )
        receiver = End("tcp", messages=100, drops=2, monitors=["gate"])
        receiver.timing = {"missed": 3}
        receiver.qos = Qos(None, None, "HIGH")
        return Flow("/a", "/b", sender, receiver, rate=50.0, speed=1234567.0)

    view = View()
    view.take(snapshot(1.0, "/a", "/b", flows=(flow(0),)))
    view.take(snapshot(3.0, "/a", "/b", flows=(flow(10),)))
    [numbers] = told(view)["numbers"]
    assert numbers[:4] == [100, 50.0, 1235000.0, None]
    assert numbers[4] in (0.001234, 0.001235)
    assert numbers[5:] == [12, 5.0, 3, None, "FIFO 30", "AF42", "gate"]


def test_ends_that_are_not_registered_are_shown() -> None:
    view = View()
    view.take(snapshot(1.0, "/a", flows=(Flow("/a", "/gone", End("tcp")),)))
    found = told(view)
    assert [port["name"] for port in found["ports"]] == ["/a", "/gone"]
    assert found["states"][1] == [None, "not registered"]
    assert found["links"] == [["/a", "/gone", "tcp"]]


def test_passing_visitors_of_ours_are_not() -> None:
    view = View()
    view.take(snapshot(1.0, "/a", flows=(Flow("/a", "peek", End("fast_tcp")), Flow("/a", ""))))
    assert told(view)["links"] == []


def test_what_happens_is_told_once() -> None:
    view = View()
    flow = Flow("/a", "/b", End("tcp", drops=0))
    view.take(snapshot(1.0, "/a", "/b"))
    assert told(view)["events"] == []
    view.take(snapshot(2.0, "/a", "/b", "/c", flows=(flow,)))
    events = told(view)["events"]
    assert [text for _, _, text in events] == ["/c appears", "/a → /b: connected"]
    assert told(view, event=events[0][0])["events"] == events[1:]
    later = snapshot(3.0, "/a", "/b", flows=(Flow("/a", "/b", End("tcp", drops=5)),))
    later.ports["/b"].state = "silent"
    view.take(later)
    assert [text for _, _, text in told(view, event=2)["events"]] == [
        "/c is closed",
        "/b: silent: its program is stopped, or very busy",
        "/a → /b: drops messages",
    ]
    assert len(told(view, event=99)["events"]) == 5  # of another program: from the beginning


def test_many_events_are_summed_up() -> None:
    view = View()
    view.take(snapshot(1.0))
    view.take(snapshot(2.0, *(f"/port{number}" for number in range(100))))
    events = told(view)["events"]
    assert len(events) == AT_ONCE + 1
    assert events[-1][2] == "... and 80 more like this"
    for number in range(2 * KEPT):
        view.happened(str(number))
    assert len(told(view)["events"]) == KEPT


def test_long_texts_are_cut_and_nothing_breaks_the_json() -> None:
    name = '/"</script>' + "x" * 10_000
    view = View()
    view.take(snapshot(1.0, name, flows=(Flow(name, "/b", End("tcp", rate=float("nan"))),)))
    found = told(view)
    assert len(found["ports"][0]["name"]) < 400
    assert found["links"][0][0] == found["ports"][0]["name"]
