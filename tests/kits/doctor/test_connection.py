"""Findings about connections; test_examination.py has the faults."""

import pytest
from support.doctor import answering, made_up

from yarpy.kits.doctor.connection import find, names_sender
from yarpy.network.traffic import End, Flow


def test_a_connection_that_came_or_went_meanwhile_is_no_fault() -> None:
    both, one = Flow("/a", "/b", End("tcp"), End("tcp")), Flow("/a", "/b", End("tcp"))
    assert [*find(made_up(both, one))] == [*find(made_up(one, both))] == []
    assert [finding.probe for finding in find(made_up(one))] == ["one-sided"]


def test_who_does_not_answer_has_forgotten_nothing() -> None:
    silent = answering("/b", state="silent")
    assert [*find(made_up(Flow("/a", "/b", End("tcp")), ports=(silent,)))] == []
    assert [*find(made_up(ports=(silent,)))] == []


@pytest.mark.parametrize(
    ("carrier", "named"),
    [
        ("tcp", True), ("udp+recv.priority", True), ("unknown", True), ("http", False),
        ("websocket", False), ("name_ser", False), ("mjpeg", False),
    ],
)  # fmt: skip
def test_carriers_that_name_no_sender_are_not_one_sided(carrier: str, named: bool) -> None:
    assert names_sender(carrier) == named
