"""Findings about what is sent; test_examination.py has the faults."""

from support.doctor import answering, made_up

from yarpy.data.stamp import Stamp
from yarpy.kits.doctor.content import find
from yarpy.kits.doctor.peek import Peek
from yarpy.network.traffic import End, Flow

FLOW = Flow("/a", "/b", End("tcp"), End("tcp"))


def test_what_cpp_declares_is_not_believed() -> None:
    image = {"/a": Peek("Image", 1000)}
    for declared in ("yarp/bottle", "yarp/image", "", "my/type"):
        case = made_up(FLOW, ports=(answering("/b", type=declared),), peeks=image)
        assert [*find(case)] == []


def test_nothing_seen_is_no_mismatch() -> None:
    case = made_up(FLOW, ports=(answering("/b", type="yarp/image"),))
    assert [*find(case)] == []


def test_old_stamps_are_a_warning_and_small_ones_a_habit() -> None:
    def found(time: float) -> list[str]:
        seen = Peek("Bottle", 8, Stamp(1, time), 2e9)
        return [finding.probe for finding in find(made_up(FLOW, peeks={"/a": seen}))]

    assert found(2e9 - 3600) == ["old-stamps"]
    assert found(12.5) == found(2e9 + 0.1) == []
    assert found(float("inf")) == ["clock-skew"]
    assert found(float("nan")) == []
