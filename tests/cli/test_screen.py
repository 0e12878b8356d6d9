"""The screen of `yarpy top`."""

import doctest

import pytest

from yarpy.cli import screen
from yarpy.cli.screen import SORTS, View, head, matches, ordered, shortened, text
from yarpy.contact import Contact
from yarpy.network.traffic import End, Flow, PortState, Snapshot


def test_examples_in_the_docstrings():
    assert doctest.testmod(screen).failed == 0


def snapshot(*names: str) -> Snapshot:
    found = Snapshot(0.0)
    for number, name in enumerate(names or ("/a", "/b", "/c")):
        found.ports[name] = PortState(name, Contact("tcp", name, "host", 1), "answers")
        end = End("tcp", number, number * 10, drops=number)
        found.flows[name, "/in"] = Flow(name, "/in", end, None, float(number), 1e6)
    return found


def lines(view: View, width: int = 80, height: int = 24, found: Snapshot | None = None):
    return text(found or snapshot(), view, width, height, 0.005).plain.split("\n")


def names(shown):
    return [line.split()[0] for line in shown[2:-1]]


def test_the_busiest_first_and_the_others_on_request():
    view = View()
    assert names(lines(view)) == ["/c", "/b", "/a"]
    view.press("r")
    assert names(lines(view)) == ["/a", "/b", "/c"]
    view.press("r")
    seen = []
    for _ in SORTS:
        seen.append(view.sort)
        view.press("s")
    assert tuple(seen) == SORTS and view.sort == "rate"
    assert names(lines(View(sort="name"))) == ["/a", "/b", "/c"]


def test_what_is_not_known_comes_last():
    flows = [Flow("/x", "/in"), *snapshot().flows.values()]
    for reverse in (False, True):
        assert ordered(flows, "rate", reverse)[-1].source == "/x"
        assert ordered(flows, "latency", reverse)[0].source == "/x"


def test_a_filter_is_typed():
    view = View()
    for key in "/bx\x7f":
        view.press(key)
    assert lines(view)[-1] == "/b_"
    assert names(lines(view)) == ["/b"]
    view.press("\r")
    view.press("s")
    assert (view.filter, view.sort) == ("b", "speed")
    for key in "/q\x1b":
        view.press(key)
    assert (view.filter, view.over) == ("", False)
    for key in (" ", "p", "q"):
        view.press(key)
    assert view.paused and view.ports and view.over


def test_filters_have_wildcards():
    assert matches("", "/a") and matches("cub", "/icub") and matches("/i*b", "/icub")
    assert not matches("/x", "/icub", "/a") and not matches("/i?", "/icub")
    assert not matches("[", "/a")


def test_ports_instead_of_connections():
    found = snapshot()
    found.ports["/b"].state = "silent"
    shown = lines(View(ports=True), found=found)
    assert shown[0].startswith("2 of 3 ports answer, 3 connections")
    assert "silent" in shown[3]


LONG = "/robot/left_arm/very/long/name/of/a/port/state:o", "/short:o"


@pytest.mark.parametrize("width", [120, 80, 60, 40, 20, 5, 1])
@pytest.mark.parametrize("height", [24, 5, 1])
def test_nothing_is_wider_or_higher_than_the_screen(width, height):
    for view in (View(), View(ports=True), View(filter="o")):
        shown = lines(view, width, height, snapshot(*LONG, *(f"/p{n}" for n in range(50))))
        assert max(map(len, shown)) <= width
        assert len(shown) <= max(height, 4)


def test_long_names_are_cut_in_their_middle():
    shown = lines(View(sort="name"), 45, found=snapshot(*LONG))
    assert shown[2].startswith("/robot/") and "…" in shown[2] and "state:o " in shown[2]
    assert shown[3].startswith("/short:o ")
    assert shortened("/abc", 1) == "/"


def test_the_head_says_what_asking_costs():
    assert head(snapshot(), View(paused=True), 0.012) == (
        "3 of 3 ports answer, 3 connections | 3 msg/s, 3.0 MB/s | by rate | paused | asked in 12 ms"
    )


def test_names_of_strangers_do_nothing_to_the_terminal():
    shown = lines(View(filter="\x1b"), found=snapshot("/a\x1b[2J"))
    assert "\x1b" not in "".join(shown)
    assert "/a\\x1b[2J" in shown[2]
