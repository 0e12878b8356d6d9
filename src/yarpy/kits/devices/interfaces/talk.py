"""LanguageModel, ChatBot: who answers in words.

Rules: until YARP 3.9 an answer of ILLM was a string, and a line had two fields. Servers of these
versions are known by that; programs of YARP 3 get it unless the server is `newer`.

Source: ILLM and IChatBot of YARP 3.9 to 4.0.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle
from yarpy.data.value import Buffer
from yarpy.kits.devices.network.model import Interface, Oldest, call
from yarpy.kits.devices.status import OK
from yarpy.kits.thrift.kind import Nested
from yarpy.kits.thrift.structure import Struct, new


class Line(Struct):
    """A line of a conversation; `type` is whose: `system`, `user`, `assistant`, `function`. Of a
    function the content is its name."""

    type: str = ""
    content: str = ""
    parameters: list[str] = new(list)
    arguments: list[str] = new(list)


class _Message(Struct):
    """A line until YARP 3.9."""

    sender: str = ""
    content: str = ""


class _Asked(Struct):
    """The answer to a question until YARP 3.9."""

    ok: bool = False
    answer: str = ""


class _Conversation(Struct):
    """All lines until YARP 3.9."""

    ok: bool = False
    lines: list[_Message] = new(list)


def _made(data: Buffer) -> Buffer:
    answer = Bottle.from_bytes(data)
    if len(answer) != 2 or not isinstance(answer[1], list):
        return data
    ok = answer[0] == OK
    if answer[1] and isinstance(answer[1][0], str):
        return _Asked(ok, answer[1][1]).to_wire()[0]
    return _Conversation(ok, [_Message(*line[:2]) for line in answer[1]]).to_wire()[0]


def _read(function: str, data: Buffer) -> Buffer:
    if function not in ("ask", "getConversation"):
        return data
    answer = Bottle.from_bytes(data)
    if len(answer) != 2:
        return data
    found = answer[1]
    if isinstance(found, str):
        return Bottle([answer[0], ["assistant", found, [], []]]).to_bytes()
    if isinstance(found, list) and all(isinstance(e, list) and len(e) == 2 for e in found):
        return Bottle([answer[0], [[*line, [], []] for line in found]]).to_bytes()
    return data


class LanguageModel(Interface):
    """A language model in a conversation."""

    NWS, NWC = "LLM_nws_yarp", "LLM_nwc_yarp"
    FAKE = "fakeLLMDevice"
    VIEW = "ILLM"
    RPC = "rpc:i"
    OLDEST = Oldest(_made, _read)

    @call("setPrompt", cpp="setPrompt")
    def begin(self, prompt: str) -> None:
        """Begin a conversation: what the model is told about itself."""

    @call("readPrompt", cpp="readPrompt")
    def prompt(self) -> str:
        """Return what it was told."""
        raise NotImplementedError

    @call("ask", cpp="ask")
    def ask(self, question: str) -> Nested[Line]:
        """Return the answer."""
        raise NotImplementedError

    @call("getConversation", cpp="getConversation")
    def conversation(self) -> list[Line]:
        """Return all lines."""
        raise NotImplementedError

    @call("deleteConversation", cpp="deleteConversation")
    def forget(self) -> None:
        """Forget the conversation and the prompt."""

    @call("refreshConversation", cpp="refreshConversation")
    def begin_again(self) -> None:
        """Forget the conversation but the prompt (YARP 4)."""


class ChatBot(Interface):
    """Somebody to talk to."""

    NWS, NWC = "chatBot_nws_yarp", "chatBot_nwc_yarp"
    FAKE = "fakeChatBotDevice"
    VIEW = "IChatBot"

    @call("interactRPC", cpp="interact")
    def interact(self, text: str) -> str:
        """Return the answer."""
        raise NotImplementedError

    @call("setLanguageRPC", cpp="setLanguage")
    def switch_language(self, language: str = "auto") -> None:
        """Speak another language, such as `it-IT`."""

    @call("getLanguageRPC", cpp="getLanguage")
    def language(self) -> str:
        """Return the language."""
        raise NotImplementedError

    @call("getStatusRPC", cpp="getStatus")
    def status(self) -> str:
        """Return how it is, in words of its own."""
        raise NotImplementedError

    @call("resetBotRPC", cpp="resetBot")
    def reset(self) -> None:
        """Begin anew."""
