"""A short run of what `make fuzz` does for hours, and everything that it ever found."""

from __future__ import annotations

import random

import pytest
from fuzz.run import CORPUS, made, tried
from fuzz.target import TARGETS, Target
from hypothesis import given, settings
from hypothesis import strategies as st

from yarpy import registry
from yarpy.link.begin.handshake import recognise
from yarpy.route import parse_carrier

FOUND = sorted(path for path in CORPUS.glob("*/*") if path.is_file())
BY_FOLDER = {name.replace(" ", "_"): target for name, target in TARGETS.items()}


@pytest.mark.parametrize("path", FOUND, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_what_was_found_once(path) -> None:  # type: ignore[no-untyped-def]
    problem, _ = tried(BY_FOLDER[path.parent.name], path.read_bytes())
    assert problem == ""


@pytest.mark.parametrize("name", TARGETS)
def test_changed_inputs(name: str) -> None:
    chance = random.Random(name)
    for _ in range(100):
        data = made(chance, TARGETS[name])
        problem, _ = tried(TARGETS[name], data)
        assert problem == "", data


@settings(max_examples=20)
@given(st.data())
@pytest.mark.parametrize("name", TARGETS)
def test_any_bytes(name: str, data: st.DataObject) -> None:
    raw = data.draw(st.binary(max_size=200))
    problem, _ = tried(TARGETS[name], raw)
    assert problem == "", raw


@pytest.mark.parametrize("name", TARGETS)
def test_seeds(name: str) -> None:
    for seed in TARGETS[name].seeds:
        problem, _ = tried(TARGETS[name], seed)
        assert problem == "", seed


def test_what_is_wrong_is_noticed() -> None:
    def wrong(data: bytes) -> None:
        raise IndexError("oh")

    assert "IndexError: oh" in tried(Target(wrong), b"")[0]
    assert tried(Target(bytes), b"")[0] == ""


def test_every_carrier_is_tried_in_both_roles() -> None:
    """But `tls`, which is tcp in TLS, and those that carry objects: `local`, `ros2`, `zenoh`."""
    carriers = {*registry.carriers.names()} - {"tls", "local", "ros2", "zenoh"}
    dialling = {name.split()[1] for name in TARGETS if name.startswith("dialling")}
    assert carriers == {parse_carrier(name).base for name in dialling}
    accepting = [name for name in TARGETS if name.startswith("accepting")]
    seeds = [seed[:8] for name in accepting for seed in TARGETS[name].seeds if len(seed) >= 8]
    found = {kind.name for kind in map(recognise, seeds) if kind is not None}
    assert carriers - found == {"rossrv"}  # begins as tcpros does
    assert any(b"service=" in seed for name in accepting for seed in TARGETS[name].seeds)
