"""LanguageModel, ChatBot: who answers in words.

Source: ILLM and IChatBot of YARP 3.10 to 4.0. (Until 3.9 the answer of ILLM was a string.)
"""

from __future__ import annotations

from yarpy.kits.devices.network.model import Interface, call
from yarpy.kits.thrift.kind import Nested
from yarpy.kits.thrift.structure import Struct, new


class Line(Struct):
    """A line of a conversation; `type` is whose: `system`, `user`, `assistant`, `function`. Of a
    function the content is its name."""

    type: str = ""
    content: str = ""
    parameters: list[str] = new(list)
    arguments: list[str] = new(list)


class LanguageModel(Interface):
    """A language model in a conversation."""

    NWS, NWC = "LLM_nws_yarp", "LLM_nwc_yarp"
    FAKE = "fakeLLMDevice"
    VIEW = "ILLM"
    RPC = "rpc:i"

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
