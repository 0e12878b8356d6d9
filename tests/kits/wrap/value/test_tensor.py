"""Files of torch, read without it: golden ones, damaged ones, and those of a real torch."""

from __future__ import annotations

import io
import json
import pickle
import random
import subprocess
import zipfile
from base64 import b64decode
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.steps import measured

from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.tensor import as_floats, read
from yarpy.kits.wrap.value.tree import from_text

PYTHON = "/usr/bin/python3"


def pickled(
    storage: str, shape: tuple[int, ...], strides: tuple[int, ...], offset: int = 0
) -> bytes:
    """The pickle that torch writes for a tensor, spelled out."""
    found = b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\nq\x00(("
    for word in ("storage", None, "0", "cpu"):
        if word is None:
            found += b"ctorch\n" + storage.encode() + b"\n"
        else:
            found += b"X" + len(word).to_bytes(4, "little") + word.encode()
    found += b"K\x06tQ" + number(offset) + row(shape) + row(strides)
    return found + b"\x89ccollections\nOrderedDict\n)RtR."


def number(value: int) -> bytes:
    if 0 <= value < 256:
        return b"K" + bytes([value])
    data = value.to_bytes(9, "little", signed=True)
    return b"\x8a" + bytes([len(data)]) + data


def row(values: tuple[int, ...]) -> bytes:
    return b"(" + b"".join(map(number, values)) + b"t"


def archive(pickle_: bytes, numbers: bytes, kind: int = zipfile.ZIP_STORED, **more: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", kind) as file:
        for name, data in {
            "data.pkl": pickle_,
            "data/0": numbers,
            "version": b"3\n",
            **more,
        }.items():
            # Not of now: what is made of a wrong file may depend on the letters of its time.
            file.writestr(zipfile.ZipInfo(f"archive/{name}"), data, kind)
    return out.getvalue()


SIX = np.arange(6, dtype="<f4")
GOOD = archive(pickled("FloatStorage", (2, 3), (3, 1)), SIX.tobytes())


def test_a_tensor() -> None:
    found = read(GOOD)
    assert found.array.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert (found.kind, found.grad) == ("float32", False) and found.array.flags.writeable
    turned = archive(pickled("FloatStorage", (2, 2), (1, 3), 1), SIX.tobytes())
    assert read(turned).array.tolist() == [[1, 4], [2, 5]]
    big = archive(
        pickled("LongStorage", (2,), (1,)), np.array([1, 2], ">i8").tobytes(), byteorder=b"big"
    )
    assert read(big).array.tolist() == [1, 2] and read(big).kind == "int64"
    assert read(archive(pickled("DoubleStorage", (), ()), b"\0" * 8)).array.shape == ()
    assert read(archive(pickled("FloatStorage", (0, 3), (3, 1)), b"")).array.shape == (0, 3)


def test_halves_of_floats() -> None:
    upper = (np.array([1.5, -2.0], "f4").view("u4") >> 16).astype("<u2")
    found = read(archive(pickled("BFloat16Storage", (2,), (1,)), upper.tobytes()))
    assert found.kind == "bfloat16" and as_floats(found).tolist() == [1.5, -2.0]


def test_what_is_repeated_takes_no_memory() -> None:
    """Whoever copies it takes that memory: so what it shows is limited, too."""
    shape = (1 << 20, 3)
    for storage, data in (("Float", SIX), ("BFloat16", (SIX.view("u4") >> 16).astype("<u2"))):
        file = archive(pickled(f"{storage}Storage", shape, (0, 1)), data.tobytes())
        with measured() as peak:
            found = as_floats(read(file))
        assert found.shape == shape and found[7].tolist() == [0, 1, 2]
        assert peak.bytes < 1 << 20


@pytest.mark.parametrize("storage", ["Float", "BFloat16", "ComplexDouble"])
def test_what_is_repeated_has_a_limit(storage: str) -> None:
    file = archive(pickled(f"{storage}Storage", (1 << 29, 2), (0, 1)), SIX.tobytes() * 2)
    with measured() as peak, pytest.raises(DecodeError, match="YARPY_MAX_UNPACKED"):
        as_floats(read(file))
    assert peak.bytes < 1 << 20


@pytest.mark.parametrize("place", ["word", "storage", "key", "offset", "shape", "strides"])
def test_references_that_form_a_graph(place: str) -> None:
    """Five hundred bytes that would be a text of 2 ** 25 words."""
    parts = {
        "word": b"X\x07\0\0\0storage",
        "storage": b"ctorch\nFloatStorage\n",
        "key": b"X\x01\0\0\x000",
        "offset": number(0),
        "shape": row((2, 3)),
        "strides": row((3, 1)),
    }
    grown = b"K\x07q\0" + b"".join(b"h%c\x86q%c" % (n, n + 1) for n in range(25))
    parts[place] = grown
    pickle_ = (
        b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\n(("
        + parts["word"] + parts["storage"] + parts["key"]
        + b"X\x03\0\0\0cpuK\x06tQ"
        + parts["offset"] + parts["shape"] + parts["strides"]
        + b"\x89ccollections\nOrderedDict\n)RtR."
    )  # fmt: skip
    with measured() as peak, pytest.raises(DecodeError) as refused:
        read(archive(pickle_, SIX.tobytes()))
    assert peak.bytes < 1 << 20 and len(str(refused.value)) < 1000


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "not a file of torch"),
        (GOOD[:300], "not a file of torch"),
        (archive(GOOD, b""), "not a file of torch"),
        (archive(pickled("FloatStorage", (2, 3), (3, 1)), b"\0" * 20), r"in 5 numbers"),
        (archive(pickled("FloatStorage", (1 << 62,) * 9, (1,) * 9), b"\0" * 4), "in 1 numbers"),
        (archive(pickled("FloatStorage", (9, 9), (1, 1)), b"\0" * 80), "in 20 numbers"),
        (archive(pickled("FloatStorage", (2,), (-1,)), b"\0" * 8), "strides"),
        (archive(pickled("FloatStorage", (2,), (1, 1)), b"\0" * 8), "strides"),
        (archive(pickled("EvilStorage", (2,), (1,)), b"\0" * 8), "EvilStorage"),
        (archive(b"\x80\x02K\x07.", b""), "holds no tensor"),
        (archive(b"\x80\x02" + b"K\x07" * 40_000, b""), "much more than a tensor"),
        (archive(b"\x80\x02" + b"K\x07" * 4_000, b""), "more than a tensor"),
        (archive(b"\x80\x02\x85.", b""), "more than a tensor"),
        (archive(b"\x80\x02]q\0h\0a.", b""), "more than a tensor"),
        (archive(pickled("FloatStorage", (2,), (1,)), b"\0" * 9999, zipfile.ZIP_DEFLATED), "comp"),
    ],
)
def test_other_files(data: bytes, why: str) -> None:
    with pytest.raises(DecodeError, match=why):
        read(data)


def test_nothing_is_called(tmp_path: Path) -> None:
    class Evil:
        def __reduce__(self) -> Any:
            return Path.touch, (tmp_path / "evil",)

    for protocol in (2, 4):
        with pytest.raises(DecodeError):
            read(archive(pickle.dumps(Evil(), protocol), b""))
    assert not (tmp_path / "evil").exists()


def test_damaged_files() -> None:
    rng = random.Random(7)
    for _ in range(2000):
        data = bytearray(GOOD)
        for _ in range(rng.randrange(1, 4)):
            data[rng.randrange(len(data))] = rng.randrange(256)
        try:
            read(bytes(data))
        except DecodeError:
            pass


@pytest.mark.peer("torch")
def test_torch_itself() -> None:
    program = """
import base64, io, json, torch
kinds = {"a": torch.arange(12).reshape(3, 4).t()[1:], "b": torch.ones(2, 3, requires_grad=True),
         "c": torch.nn.Parameter(torch.ones(2)), "d": torch.tensor([1.5, 3], dtype=torch.bfloat16),
         "e": torch.ones(1).expand(2, 2), "f": torch.tensor([True, False]),
         "g": torch.tensor([1 + 2j])}
for name, value in kinds.items():
    out = io.BytesIO()
    torch.save(value, out)
    print(json.dumps([name, base64.b64encode(out.getvalue()).decode()]))
"""
    done = subprocess.run([PYTHON, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    files = dict(map(json.loads, done.stdout.splitlines()))
    found = {name: read(b64decode(text)) for name, text in files.items()}
    assert found["a"].array.tolist() == [[1, 5, 9], [2, 6, 10], [3, 7, 11]]
    assert [found[name].grad for name in "abc"] == [False, True, True]
    assert found["b"].array.shape == (2, 3) and found["c"].array.tolist() == [1, 1]
    assert as_floats(found["d"]).tolist() == [1.5, 3] and found["e"].array.tolist() == [[1, 1]] * 2
    assert found["f"].array.tolist() == [True, False] and found["g"].array.tolist() == [1 + 2j]
    text = json.dumps({"__wrapyfi__": ["PytorchTensor", files["b"], "cpu"]})
    assert from_text(text).tolist() == [[1, 1, 1]] * 2
