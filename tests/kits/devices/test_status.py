"""The status in front of an answer, in the forms of several versions."""

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.status import FAILED, MISSING, OK, older, reason, split


def test_reasons() -> None:
    assert OK == "ok" and reason(MISSING) == "it cannot do this"
    assert reason(FAILED) == "it cannot do this, or not with these values"
    assert reason("odd") == "it says odd"


@pytest.mark.parametrize(
    ("answer", "code", "rest"),
    [
        ([Vocab("ok"), 1.5], "ok", [1.5]),
        ([[Vocab("ok")], 1.5], "ok", [1.5]),
        ([0, 1.5], "ok", [1.5]),
        ([5, 1.5], "err5", [1.5]),
        ([100], "miss", []),
        ([[Vocab("err6")]], "err6", []),
        ([Vocab("fail")], "fail", []),
        ([2.5], "fail", []),
        ([77], "err1", []),
        ([], "ok", []),
    ],
)
def test_forms(answer: list[object], code: str, rest: list[object]) -> None:
    assert split(answer) == (code, rest)


def test_the_form_of_3_12() -> None:
    answer = (
        Bottle([[Vocab("ok")], 2.5])
        .to_bytes()
        .replace(
            bytes.fromhex("09010000 01000000 6f6b0000"),
            bytes.fromhex("00010000 01000000 09000000 6f6b0000"),
        )
    )
    assert older(answer) == Bottle([0, 2.5]).to_bytes()
    alone = bytes.fromhex("00010000 01000000 09000000 65727235")
    assert older(alone) == bytes.fromhex("01000000 05000000")
    failed = bytes.fromhex("00010000 01000000 09000000 6661696c")
    assert older(failed) == failed and older(b"") == b""
    assert older(Bottle([1, 2]).to_bytes()) == Bottle([1, 2]).to_bytes()
