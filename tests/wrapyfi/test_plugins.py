"""Plug-ins for types of other libraries: with the libraries and the original, and what is refused.

Rules: the libraries are those of an environment of their own; without it one test skips.
"""

from __future__ import annotations

import base64
import io
import json
import os
import pickle
import zipfile
from pathlib import Path

import pytest
from support.peer import brings
from support.process import Process
from support.wrapyfi_plugins_venv import ready

import yarpy
from wrapyfi.plugins import zarr_array  # type: ignore[import-not-found]
from wrapyfi.plugins._extra import ours_of, pickled  # type: ignore[import-not-found]
from wrapyfi.utils._shipped import for_tag, for_type  # type: ignore[import-not-found]
from wrapyfi.utils.core_utils import PluginRegistrar  # type: ignore[import-not-found]
from wrapyfi.utils.serialization_encoders import (  # type: ignore[import-not-found]
    JsonDecodeHook,
    JsonEncoder,
)

ROOT = Path(__file__).parents[2]
PROGRAM = Path(__file__).parent / "programs" / "plugins.py"
LOADING = 240.0  # seconds: eight large libraries are imported
#: what the original sends as a pickle alone, which is refused here
PICKLED = {"frame", "series", "structure"}
#: what the original itself does not send, or not read, with the libraries of today
BROKEN = {"picture", "table", "stored", "group"}


@pytest.fixture(scope="module")
@brings("wrapyfi_plugins")
def python() -> Path:
    return ready() / "bin" / "python"


@pytest.mark.timeout(5 * LOADING)
def test_values_of_other_libraries(python: Path) -> None:
    """Between ours and the original, both ways, and from ours to ours."""
    command = [python, "-W", "ignore", PROGRAM]
    path = os.pathsep.join(map(str, (ROOT / "compat/wrapyfi/src", ROOT / "src")))
    plain = {"PATH": os.environ["PATH"]}
    with (
        Process([*command, "ours"], env={**plain, "PYTHONPATH": path}) as ours,
        Process([*command, "original"], env=plain) as original,
    ):
        sent = {}
        for one in (ours, original):
            one.wait_line("^all$", timeout=LOADING, stream="out")
            rows = [json.loads(line) for kind, line in one.lines if line[:1] == "["]
            sent[one] = {name: row for name, *row in rows}

        def read(reader: Process, writer: Process) -> dict[str, str]:
            begin = len(reader.lines)
            rows = [(name, *row) for name, row in sent[writer].items() if row[1] is not None]
            for row in rows:
                reader.write(json.dumps(row) + "\n")
            reader.write(json.dumps(["end", "", "0"]) + "\n")
            reader.wait_line(r'^\["end", "int 0"\]$', timeout=LOADING, count=done[reader])
            done[reader] += 1
            lines = [line for _, line in reader.lines[begin:] if line[:1] == "["]
            return {name: text for name, text in map(json.loads, lines) if name != "end"}

        done = {ours: 1, original: 1}
        shown = {name: row[0] for name, row in sent[ours].items()}
        assert len(shown) == 12 and all(row[1] for row in sent[ours].values())
        assert read(ours, ours) == shown
        there = read(original, ours)
        assert {name for name in shown if there[name] != shown[name]} <= BROKEN - {"picture"}
        here = read(ours, original)
        for name, text in here.items():
            if name in PICKLED:
                assert "as a pickle alone" in text
            else:
                assert text == shown[name]
        assert shown.keys() - here.keys() <= BROKEN


def test_nothing_is_unpickled() -> None:
    """What only a pickle says is refused; ours lies beside it, and is found by its mark."""
    _, tree = pickled("PandasData", [1], b"{mine")
    content = [*tree["__wrapyfi__"]]
    assert pickle.loads(content[1].encode("latin1")) == [1]
    assert ours_of("PandasData", content, b"{") == b"{mine"
    for other in (content[:2], [*content[:2], "bWluZQ=="]):
        with pytest.raises(yarpy.DecodeError, match="pickle alone"):
            ours_of("PandasData", other, b"{")


def test_stores_of_zarr() -> None:
    """Codecs that are no codecs of numbers, and stores that are larger than what came."""

    def store(**files: bytes) -> bytes:
        out = io.BytesIO()
        with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as file:
            for name, data in files.items():
                file.writestr(name.replace("_", "."), data)
        return out.getvalue()

    good = json.dumps({"codecs": [{"name": "bytes"}, {"name": "zstd"}], "shape": [1]}).encode()
    assert zarr_array._members(store(zarr_json=good)) == {"zarr.json": good}
    for tree in (
        {"filters": [{"id": "pickle"}]},
        {"codecs": [{"name": "numcodecs.pickle"}]},
        {"metadata": {"a/.zarray": {"compressor": {"id": "json2"}}}},
    ):
        with pytest.raises(yarpy.DecodeError, match="by the codec"):
            zarr_array._members(store(zarr_json=json.dumps(tree).encode()))
    with pytest.raises(yarpy.DecodeError, match="too large"):
        zarr_array._members(store(c0=bytes(80_000_000)))
    with pytest.raises(yarpy.DecodeError, match="not a zip file"):
        zarr_array._members(b"PK")


def test_which_plug_in() -> None:
    """Nothing is imported for what has no plug-in, and nobody is asked about plain values."""
    assert for_type(dict) is None and for_type(Path) is None
    assert for_tag("tuple") is None and for_tag(3) is None and for_tag("PandasData\0") is None

    class Odd:
        __module__ = "odd.things"

    with pytest.raises(TypeError, match=r"odd\.things"):
        json.dumps({"a": Odd()}, cls=JsonEncoder)


def test_a_plug_in_of_the_user_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    kind = type("Quantity", (), {"__module__": "pint.stand_in"})

    class Mine:
        def encode(self, value: object) -> tuple[bool, object]:
            return True, {"__wrapyfi__": ("Mine", "1", None, [None, (2,)])}

        def decode(self, tag: str, content: list[str]) -> tuple[bool, object]:
            return True, kind

    monkeypatch.setitem(PluginRegistrar.encoder_registry, kind, Mine)
    monkeypatch.setitem(PluginRegistrar.decoder_registry, "Mine", Mine)
    text = json.dumps([kind()], cls=JsonEncoder)
    inner = [None, {"__wrapyfi__": ["tuple", [2]]}]
    assert json.loads(text) == [{"__wrapyfi__": ["Mine", "1", None, inner]}]
    assert json.dumps({"a": [1, None, (True,)]}, cls=JsonEncoder) == (
        '{"a": [1, null, {"__wrapyfi__": ["tuple", [true]]}]}'
    )
    assert json.loads(text, object_hook=JsonDecodeHook().object_hook) == [kind]


def test_tensors_of_paddle_that_are_pickles(monkeypatch: pytest.MonkeyPatch) -> None:
    from wrapyfi.plugins import paddle_tensor  # type: ignore[import-not-found]

    monkeypatch.setattr(paddle_tensor, "HAVE_PADDLE", True)
    data = base64.b64encode(pickle.dumps([1])).decode()
    with pytest.raises(yarpy.DecodeError, match="pickle alone"):
        paddle_tensor.PaddleTensor().decode("PaddleTensor", ["PaddleTensor", data, "cpu"])
