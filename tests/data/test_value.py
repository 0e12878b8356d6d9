import copy
import math
import pickle

import pytest

from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab, fits, vocab_code, vocab_of


@pytest.mark.parametrize(
    ("kind", "low", "high"),
    [(Int8, -128, 127), (Int16, -32768, 32767), (Int64, -(2**63), 2**63 - 1)],
)
def test_widths(kind, low, high):
    assert kind(low) == low and kind(high) == high
    assert isinstance(kind(5), int) and type(kind(5) + 1) is int
    with pytest.raises(OverflowError):
        kind(low - 1)
    with pytest.raises(OverflowError):
        kind(high + 1)


def test_float32_rounds():
    assert Float32(0.1) == 0.10000000149011612
    assert Float32(1e300) == math.inf and Float32(-1e300) == -math.inf
    assert math.isnan(Float32(math.nan))
    assert type(Float32(1.5) * 2) is float


@pytest.mark.parametrize(
    ("text", "code"),
    [("set", 0x746573), ("a", 0x61), ("abcd", 0x64636261), ("abcdefgh", 0x64636261), ("", 0)],
)
def test_vocab(text, code):
    vocab = Vocab(text)
    assert vocab.code == code
    assert vocab == text[:4]
    assert Vocab.from_code(code) == vocab
    assert Vocab(vocab) == vocab and Vocab(vocab).code == code


def test_vocab_is_a_word():
    assert Vocab("set") == "set" and hash(Vocab("set")) == hash("set")
    assert {"set": 1}[Vocab("set")] == 1
    assert repr(Vocab("set")) == "Vocab('set')" and str(Vocab("set")) == "set"


def test_vocab_whose_top_bit_is_set_has_no_text():
    assert Vocab.from_code(-5) == "" and Vocab.from_code(-5).code == -5


def test_vocab_skips_zero_bytes():
    assert Vocab.from_code(0x00620061) == "ab"


def test_vocab_adds_signed_characters_as_cpp_does():
    assert vocab_code(b"\xc3\xa9") == -61 - (87 << 8)
    assert vocab_code(b"\xff\xff\xff\xff") == -0x01010101
    assert vocab_code(b"\x80\x80\x80\x80") == -0x80808080 + 2**32


def test_booleans_are_vocabs():
    assert vocab_of(0) is False
    assert vocab_of(0x31) is True
    assert vocab_of(1) == "\x01"


@pytest.mark.parametrize("value", [Vocab("set"), Vocab.from_code(-5), Int8(3), Float32(0.1)])
def test_survives_copy_and_pickle(value):
    for again in (copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert again == value and type(again) is type(value)
        assert getattr(again, "code", None) == getattr(value, "code", None)


@pytest.mark.parametrize("kind", [int, Int8, Int16, Int64])
def test_what_fits(kind):
    assert fits(kind(-128), 8) and fits(kind(127), 8)
    assert fits(-(1 << 63), 64) and not fits(1 << 63, 64)
    assert not fits(-(1 << 31) - 1, 32)
