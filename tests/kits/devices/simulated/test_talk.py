"""They say what they have heard."""

import pytest

from yarpy.kits.devices.interfaces.talk import LanguageModel, Line
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated import talk
from yarpy.kits.devices.simulated.talk import SimulatedChatBot, SimulatedLanguageModel
from yarpy.nameserver.local import LocalNames


def test_a_conversation_over_the_network(names: LocalNames) -> None:
    with (
        LanguageModel.serve("/model", SimulatedLanguageModel(), names=names),
        LanguageModel.connect("/model", names=names) as model,
    ):
        model.begin("You are a robot.")
        assert model.prompt() == "You are a robot."
        assert model.ask("Hello").content == "You said: Hello"
        assert model.ask("function").arguments == ["left", "2"]
        assert [line.type for line in model.conversation()] == [
            *("system", "user", "assistant", "user", "function")
        ]
        model.begin_again()
        assert model.conversation() == [Line("system", "You are a robot.")]


def test_what_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(talk, "TALK_LINES", 5)
    model = SimulatedLanguageModel()
    with pytest.raises(Refused, match="no conversation"):
        model.prompt()
    model.begin("me")
    with pytest.raises(Refused, match="has begun"):
        model.begin("you")
    for number in range(9):
        model.ask(str(number))
    assert len(model.conversation()) <= 6 and model.prompt() == "me"
    assert model.conversation()[-2] == Line("user", "8")
    model.forget()
    assert model.conversation() == []


def test_a_chat_bot() -> None:
    bot = SimulatedChatBot()
    assert bot.interact("Hello") == "You said: Hello" and bot.status() == "heard 1"
    bot.switch_language("it-IT")
    assert bot.language() == "it-IT"
    bot.reset()
    assert (bot.language(), bot.status()) == ("auto", "heard 0")
