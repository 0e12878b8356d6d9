"""SimulatedLanguageModel, SimulatedChatBot: they say what they have heard. fakeLLMDevice and
fakeChatBotDevice in C++.

Rules: of a conversation at most so many lines are kept, the prompt and the newest.
"""

from __future__ import annotations

from yarpy.kits.devices.interfaces.talk import Line
from yarpy.kits.devices.refusal import Refused
from yarpy.limit import TALK_LINES


class SimulatedLanguageModel:
    """Every member of `interfaces.talk.LanguageModel`."""

    def __init__(self) -> None:
        self._lines: list[Line] = []

    def begin(self, prompt: str) -> None:
        """Begin a conversation. Refused while there is one."""
        if self._has_prompt():
            raise Refused("the conversation has begun: forget it first")
        self._lines = [Line("system", prompt)]

    def prompt(self) -> str:
        """Return what it was told."""
        if not self._has_prompt():
            raise Refused("no conversation has begun")
        return self._lines[0].content

    def ask(self, question: str) -> Line:
        """Return the question; for `function`, the call of a function."""
        if question == "function":
            answer = Line("function", "wave", ["hand", "times"], ["left", "2"])
        else:
            answer = Line("assistant", f"You said: {question}")
        self._lines += (Line("user", question), answer)
        first = 1 if self._has_prompt() else 0
        del self._lines[first : max(first, len(self._lines) - TALK_LINES)]
        return answer

    def conversation(self) -> list[Line]:
        """Return all lines that are kept."""
        return [*self._lines]

    def forget(self) -> None:
        """Forget everything."""
        self._lines = []

    def begin_again(self) -> None:
        """Forget all but the prompt."""
        self._lines = [Line("system", self.prompt())]

    def _has_prompt(self) -> bool:
        return bool(self._lines) and self._lines[0].type == "system"


class SimulatedChatBot:
    """Every member of `interfaces.talk.ChatBot`."""

    def __init__(self) -> None:
        self.reset()

    def interact(self, text: str) -> str:
        """Return the same."""
        self._count += 1
        return f"You said: {text}"

    def switch_language(self, language: str = "auto") -> None:
        """Keep the value; answers stay as they are."""
        self._language = language

    def language(self) -> str:
        """Return what was written down."""
        return self._language

    def status(self) -> str:
        """Return how often somebody has talked to it."""
        return f"heard {self._count}"

    def reset(self) -> None:
        """Begin anew."""
        self._count = 0
        self._language = "auto"
