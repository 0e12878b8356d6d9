"""Findings about dialects; test_examination.py has the fault."""

from support.doctor import made_up

from yarpy.network.doctor.dialect import find
from yarpy.network.traffic import End, Flow


def test_text_is_the_same_in_both() -> None:
    for carrier, count in (("tcp", 1), ("text_ack", 0)):
        case = made_up(Flow("/a", "/b", End(carrier), End(carrier)))
        case.dialect = lambda name: 4 if name == "/a" else 3  # type: ignore[method-assign]
        assert len([*find(case)]) == count
        case.dialect = lambda name: 4 if name == "/a" else 0  # type: ignore[method-assign]
        assert [*find(case)] == []
