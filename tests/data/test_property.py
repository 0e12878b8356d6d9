import copy
import math
import pickle
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.message import bottles, kinds, scalars, texts
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.property import Property, bottle_of, text_of
from yarpy.data.value import Float32, Int8, Int64, Vocab


def test_golden():
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


def test_groups():
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


def test_pickle():
    again = pickle.loads(pickle.dumps(Property.from_text("(size 3 4)")))
    assert again == {"size": 3} and type(again) is Property


def test_keys_must_be_strings():
    with pytest.raises(TypeError, match="string keys"):
        text_of({1: 2})
    with pytest.raises(TypeError, match="string keys"):
        Bottle([{1: 2}]).to_bytes()


def test_subclass_and_repr():
    class Config(Property):
        pass

    assert type(Config.from_text("(a 1)")) is Config
    assert repr(Property(a=1)) == "Property({'a': 1})"


@given(st.dictionaries(texts, scalars | bottles, max_size=5))
def test_the_message_is_what_the_text_says(values):
    by_text = Bottle.from_text(text_of(values))
    assert repr(bottle_of(values)) == repr(by_text)
    assert kinds(bottle_of(values)) == kinds(by_text)
    assert Property(values).to_bytes() == by_text.to_bytes()


@pytest.mark.parametrize("word", ["null", "inf", "nan", "-inf", "true", "-nan"])
def test_words_that_change(word):
    changed = {"null": Vocab("null"), "inf": math.inf, "nan": math.nan}.get(word, word)
    assert repr(bottle_of({"k": [word]})) == repr(Bottle([Bottle(["k", Bottle([changed])])]))


def test_values_that_text_changes():
    negative_nan = struct.unpack("<d", b"\0\0\0\0\0\0\xf8\xff")[0]
    assert bottle_of({"k": negative_nan}) == [["k", "-nan.0"]]
    assert math.isnan(bottle_of({"k": math.nan})[0][1])
    assert bottle_of({"k": -math.inf}) == [["k", -math.inf]]
    assert bottle_of({"a": 1, "b": Vocab(")")}) == [["a", 1]], "the bracket swallows its group"
    with pytest.raises(OverflowError):
        Property(k=2**70).to_bytes()
