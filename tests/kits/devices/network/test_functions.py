"""The bytes of calls and answers, as C++ has them, in the forms of each version."""

import pytest

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.interfaces.audio import AudioPlayer
from yarpy.kits.devices.interfaces.mobile_base import MobileBase
from yarpy.kits.devices.interfaces.place import Place
from yarpy.kits.devices.interfaces.speech import SpeechSynthesizer, SpeechTranscription
from yarpy.kits.devices.network.functions import functions_of
from yarpy.kits.devices.network.model import Interface, call
from yarpy.kits.devices.status import oldest
from yarpy.kits.thrift.kind import Nested


class Lamp(Interface):
    @call("get_place_RPC")
    def place(self) -> Nested[Place]:
        raise NotImplementedError

    @call("set_on", boxed=True)
    def switch(self, on: bool) -> None: ...

    @call("flush", status=False)
    def flush(self) -> int:
        raise NotImplementedError


SERVICE = functions_of(Lamp)


def words(text: str) -> bytes:
    return bytes.fromhex(text.replace("|", ""))


PLACE = (
    "00010000 05000000 | 04000000 01000000 6d | 0a000000 000000000000f83f | "
    "0a000000 0000000000000000 | 0a000000 0000000000000000 | 04000000 00000000"
)


def test_a_service_is_made_once() -> None:
    assert functions_of(Lamp) is SERVICE
    assert [*SERVICE._methods] == ["get_place_RPC", "set_on", "flush"]
    assert SERVICE._methods["get_place_RPC"].prototype.endswith("get_place_RPC()")


@pytest.mark.parametrize(
    "front",
    [
        "00010000 01000000 09000000 6f6b0000",  # 4.0
        "09010000 01000000 6f6b0000",  # the same from a Bottle
        "01000000 00000000",  # 3.12
        "09000000 6f6b0000",  # 3.10
    ],
)
def test_results_of_each_version(front: str) -> None:
    answer = SERVICE._methods["get_place_RPC"].read_answer(
        words(f"00010000 02000000 | {front} | {PLACE}")
    )
    assert answer.status == Status("ok") and answer.value0 == Place("m", 1.5)


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ("00010000 01000000 09000000 6f6b0000", "ok"),
        ("09010000 01000000 6f6b0000", "ok"),
        ("00010000 01000000 09000000 65727235", "err5"),
        ("01000000 00000000", "ok"),
        ("01000000 05000000", "err5"),
        ("01000000 4d000000", "err1"),
    ],
)
def test_a_status_alone_of_each_version(answer: str, code: str) -> None:
    method = functions_of(MobileBase)._methods["applyVelocityCommandRPC"]
    assert method.read_answer(words(answer)).code == code


@pytest.mark.parametrize(
    "answer",
    [
        "00010000 01000000 00010000 01000000 09000000 6f6b0000",
        "00010000 01000000 09000000 6f6b0000",
        "01000000 00000000",
        "00010000 01000000 01000000 00000000",
    ],
)
def test_a_boxed_status_of_each_version(answer: str) -> None:
    assert SERVICE._methods["set_on"].read_answer(words(answer)).status.code == "ok"


def test_what_is_written() -> None:
    made = SERVICE._answers["place"]
    assert made is not None
    answer = SERVICE._methods["get_place_RPC"].answer(made(Status("ok"), Place("m", 1.5)))
    status = "00010000 01000000 09000000 6f6b0000"
    assert answer == words(f"00010000 02000000 | {status} | {PLACE}")
    assert oldest(answer) == words(f"00010000 02000000 | 09000000 6f6b0000 | {PLACE}")
    failed = SERVICE._methods["get_place_RPC"].answer(made(Status("err2"), Place("m", 1.5)))
    assert oldest(failed) == words(f"00010000 02000000 | 09000000 6661696c | {PLACE}")
    alone = functions_of(MobileBase)._methods["applyVelocityCommandRPC"].answer(Status("err2"))
    assert oldest(alone) == words("00010000 01000000 09000000 6661696c")
    assert SERVICE._methods["flush"].answer(3) == words("00010000 01000000 01000000 03000000")
    assert oldest(SERVICE._methods["flush"].answer(3)) == SERVICE._methods["flush"].answer(3)


HEARD = yarpy.Sound([[1, 2, 3]], 8000)


@pytest.mark.parametrize("form", ["3.9", "3.5", "3.10", "4.0"])
def test_sounds_of_each_version(form: str) -> None:
    """An answer with a sound, also byte by byte: that of 3.9 is no Bottle."""
    sound = HEARD.to_wire()[0] if form == "3.9" else HEARD.to_bottle(form).to_bytes()
    status = "09000000 6f6b0000" if form != "4.0" else "00010000 01000000 09000000 6f6b0000"
    data = words(f"00010000 02000000 | {status}") + bytes(sound)
    method = functions_of(SpeechSynthesizer)._methods["synthesize"]
    assert method.read_answer(data).value0 == HEARD
    ending = method.ending(1 << 20)
    for length in range(len(data)):
        assert length < ending.advance(data[:length]) <= len(data) and not ending.done
    assert ending.advance(data + b"more") == len(data) and ending.done


def test_sounds_in_questions_and_answers() -> None:
    method = functions_of(SpeechTranscription)._methods["transcribe"]
    asked = bytes(method.ask(HEARD))
    assert asked.endswith(bytes(HEARD.to_wire()[0]))
    at = len(asked) - len(HEARD.to_wire()[0])
    assert method.read_arguments(asked, at) == (HEARD,)
    newer = bytes(method.yarp4_ask((HEARD,)))
    assert newer.endswith(HEARD.to_bottle("4.0").to_bytes())
    assert method.read_arguments(newer, at) == (HEARD,)


def test_a_name_that_is_one_word() -> None:
    asked = functions_of(AudioPlayer)._methods["sw_audio_gain"].ask(0.5)
    assert Bottle.from_bytes(asked) == ["sw_audio_gain", 0.5]


def test_a_request() -> None:
    asked = functions_of(MobileBase)._methods["applyVelocityCommandRPC"].ask(1.0, 2.0, 3.0, 0.5)
    assert Bottle.from_bytes(asked) == ["applyVelocityCommandRPC", 1.0, 2.0, 3.0, 0.5]
    assert Bottle.from_bytes(SERVICE._methods["set_on"].ask(True)) == [
        Vocab("set"),
        "on",
        Vocab("ok"),
    ]
