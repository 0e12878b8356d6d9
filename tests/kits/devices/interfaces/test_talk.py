"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.talk import ChatBot, LanguageModel
from yarpy.nameserver.local import LocalNames


def test_chatbot(names: LocalNames) -> None:
    check_every_member(ChatBot, names)


def test_languagemodel(names: LocalNames) -> None:
    check_every_member(LanguageModel, names)
