import copy
import pickle

import pytest

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError


def test_is_a_list():
    bottle = Bottle(["set", 1, [2.0]])
    assert bottle == ["set", 1, [2.0]]
    assert repr(bottle) == "Bottle(['set', 1, [2.0]])"
    assert copy.deepcopy(bottle) == bottle and type(copy.copy(bottle)) is Bottle
    assert type(pickle.loads(pickle.dumps(bottle))) is Bottle


def test_spellings():
    bottle = Bottle.from_text("set pos 3 10.5")
    assert bottle == ["set", "pos", 3, 10.5]
    assert bottle.to_text() == "set pos 3 10.5"
    assert Bottle.from_bytes(bottle.to_bytes()) == bottle
    assert type(Bottle.from_text("(1)")[0]) is Bottle
    with pytest.raises(DecodeError):
        Bottle.from_bytes(b"set pos 3")


def test_subclasses_stay():
    class Command(Bottle):
        pass

    assert type(Command.from_text("a")) is Command
    assert type(Command.from_bytes(Bottle(["a"]).to_bytes())) is Command


@pytest.mark.parametrize(
    ("text", "key", "found"),
    [
        ("a 1 (b 2 3)", "a", 1),
        ("a 1 (b 2 3)", "b", 2),
        ("a 1 (b 2 3)", "1", [("b"), 2, 3]),
        ("a 1 (b 2 3)", "c", None),
        ("x a", "a", None),
        ("(a)", "a", None),
        ("[set] 5", "set", 5),
        ("(1 one) (1.5 two)", "1", "one"),
        ("(1 one) (1.5 two)", "1.5", "two"),
        ("(a 1) (a 2) a 3", "a", 1),
        ("a 3 (a 1)", "a", 3),
        ("(a) (a 1)", "a", None),
        ("((p q) 7)", "p q", 7),
        ('"two words" 7', "two words", 7),
        ("true 4", "true", 4),
    ],
)
def test_find(text, key, found):
    bottle = Bottle.from_text(text)
    assert bottle.find(key) == found
    assert bottle.find(key, "default") == ("default" if found is None else found)


def test_group_and_check():
    bottle = Bottle.from_text("a 1 (b 2 3) (a 5) (c) d")
    assert bottle.group("b") == ["b", 2, 3]
    assert bottle.group("a") is None, "the plain word comes first"
    assert bottle.group("c") == ["c"]
    assert bottle.group("x") is None
    assert bottle.check("a") and bottle.check("b") and bottle.check("c")
    assert not bottle.check("d"), "the last word has no value"
    assert not bottle.check("x")
    assert Bottle([("k", 1)]).find("k") == 1
    assert type(Bottle([["k", 1]]).group("k")) is Bottle
