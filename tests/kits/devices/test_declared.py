"""Services that are declared in one line a function: their questions and answers, as bytes."""

import pytest

from yarpy.kits.devices.declared import Answer, Status, function
from yarpy.kits.thrift.kind import i32
from yarpy.kits.thrift.service import Service


class Level(Answer):
    level: float = 0.0


class LampMsgs(Service):
    level = function(Level)
    dim_lamp = function(Status, lamp=i32, level=float)


def test_a_question_has_the_arguments() -> None:
    method = LampMsgs._methods["dim_lamp"]
    assert method.prototype == "Status dim_lamp(i32 lamp, double level)"
    assert method.ask(3, 0.5) == bytes.fromhex(
        "00010000 04000000 | 09000000 64696d00 | 09000000 6c616d70 | 01000000 03000000"
        "| 0a000000 000000000000e03f".replace("|", "")
    )


def test_an_answer_has_the_status_in_front() -> None:
    told = LampMsgs._methods["level"].answer(Level(Status("ok"), 0.5))
    assert told == bytes.fromhex(
        "00010000 02000000 | 00010000 01000000 09000000 6f6b0000 "
        "| 0a000000 000000000000e03f".replace("|", "")
    )


def test_who_serves_it_defines_the_functions() -> None:
    with pytest.raises(NotImplementedError):
        LampMsgs().level()
