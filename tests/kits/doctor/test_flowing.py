"""Findings about the flow of messages; test_examination.py has the faults."""

from support.doctor import answering, made_up

from yarpy.kits.doctor.flowing import find
from yarpy.kits.doctor.peek import Peek
from yarpy.network.traffic import End, Flow


def test_a_reader_that_takes_some_reads() -> None:
    case = made_up(
        Flow("/a", "/b", End(messages=5, drops=0), End(messages=5, delivered=5, waiting=3)),
        Flow("/a", "/b", End(messages=9, drops=0), End(messages=9, delivered=9, waiting=5)),
    )
    assert [*find(case)] == []


def test_what_waits_came_from_others_too() -> None:
    case = made_up(
        Flow("/a", "/b", End(messages=5), End(messages=5, delivered=5, waiting=1)),
        Flow("/a", "/b", End(messages=5), End(messages=5, delivered=5, waiting=4)),
        Flow("/c", "/b", End(messages=1), End(messages=1, delivered=1, waiting=1)),
        Flow("/c", "/b", End(messages=4), End(messages=4, delivered=4, waiting=4)),
    )
    assert {finding.probe for finding in find(case)} == {"never-reads"}


def test_of_a_sender_that_does_not_count_a_look_decides() -> None:
    flow = Flow("/a", "/b", End("tcp"), End("tcp", messages=5))
    assert [*find(made_up(flow, peeks={"/a": Peek("Bottle", 8)}))] == []
    assert [finding.probe for finding in find(made_up(flow))] == ["writes-nothing"]
    both = Flow("/a", "/b", End("tcp"), End("tcp"))  # C++ at either end
    assert [finding.probe for finding in find(made_up(both))] == ["writes-nothing"]
    assert [*find(made_up(both, peeks={"/a": Peek(error="you may not")}))] == []


def test_a_network_at_rest_is_no_fault() -> None:
    assert [*find(made_up(Flow("/a", "/b", End(messages=5), End(messages=5)), wanted=()))] == []


def test_who_writes_nothing_is_named_once_and_who_asks_never() -> None:
    flows = [Flow("/a", f"/{n}", End(messages=5), End(messages=5)) for n in range(3)]
    assert len([*find(made_up(*flows, wanted=("/a",)))]) == 1
    for name in ("/a", "/0"):
        asks = answering(name, is_rpc=True)
        assert [*find(made_up(flows[0], wanted=("/a",), ports=(asks,)))] == []
