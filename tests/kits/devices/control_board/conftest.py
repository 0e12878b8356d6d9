"""A board that says what a test wants it to say, and who asks it."""

import pytest

import yarpy
from yarpy import Bottle
from yarpy.kits.devices.control_board.requests import Requests


class Parrot:
    """A board with the answers a test gives it, and a memory for requests."""

    def __init__(self, names):
        self.heard = []
        self.answers = {}
        self.server = yarpy.RpcServer("/head/rpc:i", self.answer, names=names)

    def answer(self, message):
        text = message.as_(Bottle).to_text()
        self.heard.append(text)
        return Bottle.from_text(self.answers.get(text, "[ok]"))


@pytest.fixture
def parrot(names):
    parrot = Parrot(names)
    with parrot.server:
        yield parrot


@pytest.fixture
def ask(parrot, names):
    with Requests("/head", "/me", names) as requests:
        parrot.answers["[get] [axes]"] = "[is] [axes] 3 [tsta] 0 1.0 [ok]"
        assert requests.count_axes() == 3
        parrot.heard.clear()
        yield requests
