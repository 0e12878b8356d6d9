import copy
import pickle

import pytest
from support.vectors import rows

from yarpy.data.bottle import Bottle, Property
from yarpy.data.value import Float32, Int8, Int64, Vocab
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


# Property


def test_property_golden():
    (row,) = (row for row in rows("types") if row["type"] == "property")
    values = Property(row["params"])
    assert values.to_bytes().hex() == row["binary"]
    assert values.to_text().encode() + b"\r\n" == bytes.fromhex(row["text_hex"])
    assert Property.from_bytes(bytes.fromhex(row["binary"])) == values
    assert Property.from_text(values.to_text()) == values


def test_captured_messages():
    inner = (
        "0001000002000000"
        "0401000002000000010000006101000000780001000002000000040000000100"
        "00006b0100000001000000"
    )
    assert Property({"k": 1, "a": "x"}).to_bytes().hex() == inner
    element = "0001000001000000" + "00030000" + inner
    assert Bottle([{"k": 1, "a": "x"}]).to_bytes().hex() == element
    assert Bottle([Property(k=1, a="x")]).to_text() == "((a x) (k 1))"
    assert Property().to_bytes() == Bottle().to_bytes()


def test_keys_are_sorted_by_their_bytes():
    values = Property({"b": 1, "B": 2, "é": 3, "a b": 4, "": 5, "\udcff": 6})
    text = values.to_text()
    assert text == '("" 5) (B 2) ("a b" 4) (b 1) ("é" 3) ("\udcff" 6)'


def test_writing_goes_through_text():
    values = Property(
        i=Int8(3), l=Int64(5), f=Float32(0.5), d={"x": 1}, s="null", v=Vocab("ok"), t=True
    )
    again = Property.from_bytes(values.to_bytes())
    assert again == {
        "i": 3,
        "l": 5,
        "f": 0.5,
        "d": [["x", 1]],
        "s": "null",
        "v": "ok",
        "t": True,
    }
    assert type(again["i"]) is int and type(again["l"]) is int and type(again["f"]) is float
    assert type(again["s"]) is Vocab and type(again["d"]) is Bottle


def test_only_lists_count_and_the_last_wins():
    values = Property.from_text("a 1 (b 2) word (c 3) (b 4) {1}")
    assert values == {"b": 4, "c": 3}


def test_groups_of_a_property():
    values = Property.from_text("(size 3 4) (flag) (1 one)")
    assert values == {"size": 3, "flag": None, "1": "one"}
    assert values.group("size") == ["size", 3, 4]
    assert values.group("flag") == ["flag"]
    assert values.group("x") is None
    assert values.to_text() == "(1 one) (flag) (size 3 4)"
    assert values.check("flag") and not values.check("x")
    assert values.find("x", 7) == 7


def test_another_value_replaces_the_group():
    values = Property.from_text("(size 3 4)")
    values["size"] = 5
    assert values.group("size") == ["size", 5]
    assert values.to_text() == "(size 5)"
    values = Property.from_text("(size 3 4) (size 9)")
    assert values.to_text() == "(size 9)"


def test_empty_list_is_an_empty_key():
    assert Property.from_text("()") == {"": None}


def test_update_takes_whole_groups():
    values = Property.from_text("(a 1) (colour 1 2)")
    values.update(Property.from_text("(colour 3 4 5) (b 2)"), c=7)
    assert values.to_text() == "(a 1) (b 2) (c 7) (colour 3 4 5)"
    values.update({"colour": 6})
    assert values.to_text() == "(a 1) (b 2) (c 7) (colour 6)"


def test_dict_elements_are_not_groups():
    assert Property.from_bottle([{"a": 1}, ("b", 2)]) == {"b": 2}


@pytest.mark.parametrize("clone", [copy.copy, copy.deepcopy, Property.copy, Property])
def test_copies_keep_groups(clone):
    values = Property.from_text("(size 3 4)")
    again = clone(values)
    assert type(again) is Property and again == values
    assert again.group("size") == ["size", 3, 4]


def test_pickle_of_a_property():
    again = pickle.loads(pickle.dumps(Property.from_text("(size 3 4)")))
    assert again == {"size": 3} and type(again) is Property


def test_keys_must_be_strings():
    with pytest.raises(TypeError, match="string keys"):
        Property({1: 2}).to_text()
    with pytest.raises(TypeError, match="string keys"):
        Bottle([{1: 2}]).to_bytes()


def test_subclass_and_repr_of_a_property():
    class Config(Property):
        pass

    assert type(Config.from_text("(a 1)")) is Config
    assert repr(Property(a=1)) == "Property({'a': 1})"
