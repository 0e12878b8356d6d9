"""Findings about dialects; test_examination.py has the fault."""

from support.doctor import answering, made_up

from yarpy.kits.doctor.dialect import find
from yarpy.network.traffic import End, Flow


def test_text_is_the_same_in_both() -> None:
    for carrier, count in (("tcp", 1), ("text_ack", 0)):
        cpp = (answering("/a", ours=False), answering("/b", ours=False))
        case = made_up(Flow("/a", "/b", End(carrier), End(carrier)), ports=cpp)
        case.dialect = lambda name: 4 if name == "/a" else 3  # type: ignore[method-assign]
        assert len([*find(case)]) == count
        case.dialect = lambda name: 4 if name == "/a" else 0  # type: ignore[method-assign]
        assert [*find(case)] == []


def test_ports_of_yarpy_write_as_their_reader_reads() -> None:
    for carrier, count in (("tcp", 0), ("mcast", 1)):
        cpp = (answering("/b", ours=False),)
        case = made_up(Flow("/a", "/b", End(carrier), End(carrier)), ports=cpp)
        case.dialect = lambda name: 3 if name == "/a" else 4  # type: ignore[method-assign]
        assert len([*find(case)]) == count


def test_ports_of_yarpy_read_both() -> None:
    case = made_up(Flow("/a", "/b", End("tcp"), End("tcp")))
    case.dialect = lambda name: 4 if name == "/a" else 3  # type: ignore[method-assign]
    assert [*find(case)] == []
