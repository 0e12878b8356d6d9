"""Every member of the interfaces, over the network; and what C++ 3.9.1 was recorded to say."""

import pytest
from support.interface import check_every_member
from support.wait import HANG

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.interfaces.talk import ChatBot, LanguageModel, Line
from yarpy.kits.devices.refusal import Refused
from yarpy.nameserver.local import LocalNames
from yarpy.wire.message import Encoded

#: Questions to fakeLLMDevice of 3.9.1 behind LLM_nws_yarp, and its answers.
OK = "0001000002000000 090000006f6b0000"
LINE = "0001000002000000 0400000006000000 73797374656d 0400000008000000 62652073686f7274"
RECORDED = {
    ("getConversation",): f"{OK} 0001000001000000 {LINE}",
    ("ask", "why"): f"{OK} 0400000005000000 466174746f",
    ("readPrompt",): f"{OK} 0400000008000000 62652073686f7274",
    ("ask", ""): "0001000002000000 090000006661696c 0400000000000000",
    ("setPrompt", "again"): "0001000001000000 090000006661696c",
    ("deleteConversation",): "0001000001000000 090000006f6b0000",
}


class Model:
    def begin(self, prompt: str) -> None:
        raise Refused("the conversation has begun")

    def prompt(self) -> str:
        return "be short"

    def ask(self, question: str) -> Line:
        if not question:
            raise Refused("nothing is asked")
        return Line("assistant", "Fatto")

    def conversation(self) -> list[Line]:
        return [Line("system", "be short")]

    def forget(self) -> None: ...


def test_chatbot(names: LocalNames) -> None:
    check_every_member(ChatBot, names)


def test_languagemodel(names: LocalNames) -> None:
    check_every_member(LanguageModel, names)


@pytest.mark.parametrize("question", RECORDED, ids=" ".join)
def test_answers_as_3_9_reads_them(names: LocalNames, question: tuple[str, ...]) -> None:
    with (
        LanguageModel.serve("/model", Model(), names=names),
        yarpy.RpcClient("/model/rpc:i", names=names) as port,
    ):
        message = port.ask(Bottle(question), HANG)
        assert message is not None
        assert bytes(message.to_bytes()) == bytes.fromhex(RECORDED[question])


def test_no_lines_as_3_9_reads_them(names: LocalNames) -> None:
    device = Model()
    device.conversation = list  # type: ignore[method-assign, assignment]
    with (
        LanguageModel.serve("/model", device, names=names),
        yarpy.RpcClient("/model/rpc:i", names=names) as port,
    ):
        message = port.ask(Bottle(["getConversation"]), HANG)
        assert message is not None
        assert bytes(message.to_bytes()) == bytes.fromhex(f"{OK} 0001000000000000")


def test_answers_of_3_9_are_read(names: LocalNames) -> None:
    def answer(message: yarpy.Message) -> object:
        known = RECORDED.get(tuple(message.as_(Bottle)))
        return Bottle(["fail"]) if known is None else Encoded(bytes.fromhex(known))

    with (
        yarpy.RpcServer("/model/rpc:i", answer, names=names),
        LanguageModel.connect("/model", names=names) as client,
    ):
        assert client.prompt() == "be short"
        assert client.ask("why") == Line("assistant", "Fatto")
        assert client.conversation() == [Line("system", "be short")]
        client.forget()
        for refused in (lambda: client.ask(""), lambda: client.begin("again")):
            with pytest.raises(LocalProtocolError, match='"/model" refuses'):
                refused()
