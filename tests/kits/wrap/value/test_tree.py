"""Trees: values as JSON with tags. The texts were recorded from Wrapyfi 0.5.0."""

from __future__ import annotations

import json
import pickle
from base64 import b64encode
from datetime import datetime

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.value.frame import from_parts
from yarpy.kits.wrap.value.npy import to_npy
from yarpy.kits.wrap.value.tree import TreeEncoder, decode_tree, from_text, to_text

RECORDED = [
    ({"i": 0, "t": (1, 2)}, '{"i": 0, "t": {"__wrapyfi__": ["tuple", [1, 2]]}}'),
    ([(1, 2)], '[{"__wrapyfi__": ["tuple", [1, 2]]}]'),
    ({1}, '{"__wrapyfi__": ["set", [1]]}'),
    ("é", '"\\u00e9"'),
    (None, "null"),
    ({"2": [1.5, True]}, '{"2": [1.5, true]}'),
    (datetime(2026, 1, 2, 3), '{"__wrapyfi__": ["datetime", "2026-01-02T03:00:00"]}'),
    (np.float64(1.5), "1.5"),
    (np.datetime64("2026-01-02"), '{"__wrapyfi__": ["numpy.datetime64", "2026-01-02"]}'),
]


@pytest.mark.parametrize(("value", "text"), RECORDED)
def test_texts_of_wrapyfi(value: object, text: str) -> None:
    assert to_text(value) == text
    assert from_text(text) == value


def test_arrays_in_a_text() -> None:
    text = to_text({"a": np.arange(2)})
    assert text.startswith('{"a": {"__wrapyfi__": ["numpy.ndarray", "k05VTVBZ')
    assert np.array_equal(from_text(text)["a"], np.arange(2))


def test_an_array_alone_passes_json_by(monkeypatch: pytest.MonkeyPatch) -> None:
    array = np.arange(6, dtype="i2").reshape(2, 3)
    text = json.dumps(TreeEncoder(None).encode(array))

    def never(*arguments: object, **options: object) -> None:
        raise AssertionError("JSON looks at each character")

    with monkeypatch.context() as patch:
        patch.setattr(json, "dumps", never)
        patch.setattr(json, "loads", never)
        assert to_text(array) == text
        for came in (text, text.encode()):
            assert np.array_equal(from_text(came), array)
    escaped = text.replace("k05V", "\\u006b05V")  # as others may write it
    assert np.array_equal(from_text(escaped), array)
    for wrong in (text[:-5] + '", "x"]}', text.replace("k05V", "k\u00e9")):
        with pytest.raises(yarpy.DecodeError):
            from_text(wrong)


def test_nested_tuples_are_marked_on_every_level() -> None:
    assert from_text(to_text((1, (2, 3)))) == (1, (2, 3))


@pytest.mark.parametrize("value", [b"x", 1j, object(), print, {"a": b"x"}, yarpy.Image])
def test_what_a_text_cannot_hold(value: object) -> None:
    with pytest.raises(TypeError, match="cannot be sent"):
        to_text(value)


@pytest.mark.parametrize(
    "value",
    [
        b"abc",
        3 + 4j,
        {1: 2, (1, 2): {3}},
        frozenset({1}),
        {"__wrapyfi__": ["tuple", [1]]},
        [b"", {}],
    ],
)
def test_what_only_frames_hold(value: object) -> None:
    buffers: list[np.ndarray] = []
    tree = json.loads(json.dumps(TreeEncoder(buffers).encode(value)))
    assert decode_tree(tree, buffers) == value


def test_unknown_and_odd_tags_stay_what_they_are() -> None:
    for text in ('{"__wrapyfi__": ["Thing", 1]}', '{"__wrapyfi__": 3}', '{"__wrapyfi__": []}'):
        assert from_text(text) == json.loads(text)


def test_pickles_are_never_read() -> None:
    """Not even those that do no harm."""
    data = pickle.dumps([1], protocol=5).decode("latin-1")
    for tag in ("PandasData", "TraxArray", "PyArrowArray", "PaddleTensor"):
        with pytest.raises(yarpy.DecodeError, match="runs code"):
            from_text(json.dumps({"__wrapyfi__": [tag, data]}))


def test_arrays_of_other_libraries_come_without_them() -> None:
    npy = b64encode(to_npy(np.arange(3))).decode()
    for tag in ("JAXTensor", "TensorflowTensor", "MXNetTensor", "CuPyArray"):
        found = from_text(json.dumps({"__wrapyfi__": [tag, npy, "cuda:0"]}))
        assert np.array_equal(found, np.arange(3))


@pytest.mark.parametrize(
    "text",
    [
        *("", "{", "nope", "[" * 100_000, "1" * 5000, '{"__wrapyfi__": ["numpy.ndarray", "?"]}'),
        *('{"__wrapyfi__": ["tuple", 3]}', '{"__wrapyfi__": ["set", [[1]]]}'),
        *('{"__wrapyfi__": ["datetime", "soon"]}', '{"__wrapyfi__": ["bytes", {"b": 0}]}'),
        *('{"__wrapyfi__": ["bytes", {"b": -1}]}', '{"__wrapyfi__": ["complex", 1]}'),
    ],
)  # fmt: skip
def test_bad_texts(text: str) -> None:
    with pytest.raises(yarpy.DecodeError):
        from_text(text)


@pytest.mark.parametrize("tag", ["set", "frozenset", "dict"])
def test_elements_that_all_have_the_same_hash(tag: str) -> None:
    """They would be compared with one another, fifty thousand with fifty thousand."""
    same = [n * ((1 << 61) - 1) for n in range(1, 2000)]
    items = [[n, 0] for n in same] if tag == "dict" else same
    with pytest.raises(yarpy.DecodeError, match="same hash"):
        from_text(json.dumps({"__wrapyfi__": [tag, items]}))
    assert len(from_text(json.dumps({"__wrapyfi__": ["set", list(range(-9, 99_999))]}))) == 100_008


def test_many_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "70000")
    assert len(from_text("[" + "1," * 60_000 + "1]")) == 60_001
    text = "[" + "[]," * 70_000 + "1]"
    with pytest.raises(yarpy.DecodeError, match="YARPY_MAX_ELEMENTS"):
        from_text(text)
    with pytest.raises(yarpy.DecodeError, match="YARPY_MAX_ELEMENTS"):
        from_parts([f'{{"yarpy": 1, "tree": {text}}}'.encode()])


def test_an_array_without_end_in_a_text() -> None:
    """Two hundred letters that were ten billion bytes."""
    text = "{'descr': '|S0', 'fortran_order': False, 'shape': (10**10,), }".ljust(117) + "\n"
    npy = b64encode(b"\x93NUMPY\1\0\x76\0" + text.encode()).decode()
    with pytest.raises(yarpy.DecodeError):
        from_text(json.dumps({"__wrapyfi__": ["numpy.ndarray", npy]}))


def test_value_that_holds_itself() -> None:
    value: list[object] = []
    value.append(value)
    with pytest.raises(ValueError, match="levels deep"):
        to_text(value)
