"""Tensors: of a real torch, between networks and with real Wrapyfi; of others by stand-ins.

Rules: torch is Debian's, with the packages that real Wrapyfi has; where it is missing tests skip.
"""

from __future__ import annotations

import json
import os
import re
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.peer import brings
from support.process import Process
from support.ros import PYTHON
from support.wait import HANG
from support.wrapyfi_venv import prepare

pytest.importorskip("zmq")

from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder

ROOT = Path(__file__).parents[2]
PROGRAMS = Path(__file__).parent / "programs"


@pytest.fixture(scope="module")
@brings("wrapyfi", "torch")
def site() -> Path:
    return next(prepare().glob("lib/python*/site-packages"))


def ours(site: Path, program: str, *words: str) -> Process:
    """A program with torch and our package."""
    path = os.pathsep.join(map(str, (ROOT / "compat/wrapyfi/src", ROOT / "src", site)))
    known = {"PATH": os.environ["PATH"], "PYTHONPATH": path, "WRAPYFI_DEFAULT_MWARE": "yarp"}
    return Process([PYTHON, "-W", "ignore", PROGRAMS / program, *words], env=known)


def test_networks(site: Path) -> None:
    sums = [6.0 * number for number in range(1, 10)]
    with ours(site, "network.py", "ensemble") as first, ours(site, "network.py", "chain") as second:
        line = rf"^ensemble {re.escape(str(sums))}$"
        first.wait_line(line, timeout=2 * HANG, stream="out")
        second.wait_line(r"^chain \[3.0, 3.0, 3.0\]$", timeout=2 * HANG, stream="out")


def test_torch_crosses(site: Path) -> None:
    plugins = {"WRAPYFI_PLUGIN_PATHS": str(site / "wrapyfi"), "PYTHONPATH": str(site)}
    command = [PYTHON, "-W", "ignore", PROGRAMS / "tensors.py"]
    environment = {"PATH": os.environ["PATH"], **plugins}
    with Process(command, env=environment) as real, ours(site, "tensors.py") as here:
        texts = [
            one.wait_line(r"^(\{.*\})$", timeout=2 * HANG, stream="out")[0] for one in (real, here)
        ]
        for one, text in zip((here, real), texts, strict=True):
            one.write(f"{text}\n")
            line = one.wait_line(r"^\{'a': .*$", timeout=HANG, stream="out")[0]
            words = "".join(line.split())
            assert "'a':tensor([[0.,1.,2.],[3.,4.,5.]])" in words
            assert "(tensor([1.,1.],dtype=torch.bfloat16),tensor([[1.,1.],[1.,1.]]),tens" in words
            assert "'c':tensor([1.,1.],requires_grad=True)" in words


def test_arrays_of_other_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    """By stand-ins for JAX and CuPy: the tags, the devices, and what there is without them."""

    class Array:
        __module__ = "jax.stand_in"

        def __init__(self, data: Any) -> None:
            self.data = np.asarray(data)
            self.shape = self.data.shape
            self.device = types.SimpleNamespace(id=1)

        def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
            return self.data

        def get(self) -> Any:
            return self.data

    class Device:
        chosen: list[int] = []

        def __init__(self, number: int) -> None:
            Device.chosen.append(number)

        def __enter__(self) -> None: ...

        def __exit__(self, *_: object) -> None: ...

    other = type("Other", (Array,), {"__module__": "cupy"})
    text = json.dumps({"j": Array([1, 2]), "c": other([3.5])}, cls=JsonEncoder)
    tags = json.loads(text)
    assert tags["j"]["__wrapyfi__"][0] == "JAXTensor" and len(tags["j"]["__wrapyfi__"]) == 2
    assert tags["c"]["__wrapyfi__"][::2] == ["CuPyArray", "cuda:1"]
    plain = json.loads(text, object_hook=JsonDecodeHook().object_hook)
    assert plain["j"].tolist() == [1, 2] and plain["c"].tolist() == [3.5]
    library = types.ModuleType("jax")
    library.numpy = types.SimpleNamespace(array=Array)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "jax", library)
    card = types.ModuleType("cupy")
    card.cuda = types.SimpleNamespace(Device=Device)  # type: ignore[attr-defined]
    card.array = other  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "cupy", card)
    hook = JsonDecodeHook(load_cupy_device="cuda:0", map_cupy_devices={"cuda:1": "cuda:3"})
    found = json.loads(text, object_hook=hook.object_hook)
    assert type(found["j"]) is Array and type(found["c"]) is other and Device.chosen == [3]
