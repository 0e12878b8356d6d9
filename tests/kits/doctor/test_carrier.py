"""Findings about carriers; test_examination.py has the faults."""

from support.doctor import made_up

from yarpy.kits.doctor.carrier import find
from yarpy.kits.doctor.peek import Peek
from yarpy.network.traffic import End, Flow


def test_some_losses_are_a_warning() -> None:
    case = made_up(
        Flow("/a", "/b", End("udp", 5, 500), End("udp", 5, 500, lost=0)),
        Flow("/a", "/b", End("udp", 9, 900), End("udp", 8, 800, lost=1)),
    )
    [finding] = find(case)
    assert (finding.probe, finding.level) == ("lost-datagrams", "warning")


def test_datagrams_that_never_arrive() -> None:
    case = made_up(
        Flow("/a", "/b", End("udp", 5, 500), End("udp", 0, 0, lost=0)),
        Flow("/a", "/b", End("udp", 9, 900), End("udp", 0, 0, lost=0)),
    )
    [finding] = find(case)
    assert (finding.probe, "firewall" in finding.verdict) == ("nothing-arrives", True)


def test_short_texts_are_what_text_is_for() -> None:
    flow = Flow("/a", "/b", End("text"), End("text"))
    assert [*find(made_up(flow, peeks={"/a": Peek("Vector", 24)}))] == []
    assert [*find(made_up(flow, peeks={"/a": Peek("Vector", 1 << 20)}))]
