"""dash_peek: the newest message of any port, as text or as a picture, while somebody asks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from support.wait import wait_until

import yarpy
from yarpy.data.sig import jpeg
from yarpy.kits.views import dash_peek
from yarpy.kits.views.dash_peek import Peeks
from yarpy.network.sampling import Sampler


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def peeks() -> Iterator[Peeks]:
    found = Peeks()
    yield found
    found.rest(everybody=True)


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/out", names=names) as port:
        yield port


def look(names: yarpy.LocalNames) -> object:
    with Sampler(names) as sampler:
        return sampler.look()


def test_text(names: yarpy.LocalNames, out: yarpy.Port, peeks: Peeks) -> None:
    seen = look(names)
    first = peeks.told("/out", seen)
    assert (first["count"], first["problem"]) == (0, "")
    wait_until(lambda: out.outputs)
    out.write(["angle", 45.0])
    wait_until(lambda: peeks.told("/out", seen)["count"] == 1)
    found = peeks.told("/out", seen)
    assert (found["text"], found["image"]) == ("angle 45.0", False)
    out.write(list(range(5000)))
    wait_until(lambda: peeks.told("/out", seen)["count"] == 2)
    assert peeks.told("/out", seen)["text"].endswith("characters)")
    out.write(yarpy.Vector(np.zeros(100_000)))
    wait_until(lambda: peeks.told("/out", seen)["count"] == 3)
    assert "bytes)" in peeks.told("/out", seen)["text"]
    assert peeks.picture("/out") is None


def test_pictures(names: yarpy.LocalNames, out: yarpy.Port, peeks: Peeks) -> None:
    seen = look(names)
    peeks.told("/out", seen)
    wait_until(lambda: out.outputs)
    out.write(yarpy.Image(np.full((60, 80, 3), 200, np.uint8)))
    wait_until(lambda: peeks.told("/out", seen)["count"] == 1)
    assert peeks.told("/out", seen)["image"]
    picture = peeks.picture("/out")
    assert picture is not None
    assert len(jpeg.decode(picture)) >= 60 * 80 * 3


def test_who_receives_is_seen_where_it_comes_from(
    names: yarpy.LocalNames, out: yarpy.Port, peeks: Peeks
) -> None:
    with yarpy.BufferedPort("/in", names=names):
        out.connect("/in")
        seen = look(names)
        assert peeks.told("/in", seen)["of"] == "from /out: "


def test_questions(names: yarpy.LocalNames, peeks: Peeks) -> None:
    with yarpy.RpcServer("/ask", lambda message: "yes", names=names):
        seen = look(names)
        wait_until(lambda: peeks.told("/ask", seen)["of"] == "questions: ")
        with yarpy.RpcClient("/ask", names=names) as client:
            seen = look(names)
            wait_until(lambda: client.ask([1]) and peeks.told("/ask", seen)["count"])
            assert "yes" in peeks.told("/ask", seen)["text"]


def test_nobody_asks_any_more(
    names: yarpy.LocalNames, out: yarpy.Port, peeks: Peeks, monkeypatch: pytest.MonkeyPatch
) -> None:
    peeks.told("/out", look(names))
    wait_until(lambda: out.outputs)
    peeks.rest()
    assert out.outputs
    monkeypatch.setattr(dash_peek, "WANTED", -1.0)  # clocks stand still for 16 ms on Windows
    peeks.rest()
    wait_until(lambda: not out.outputs)


def test_who_cannot_be_looked_at(
    names: yarpy.LocalNames, out: yarpy.Port, peeks: Peeks, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "being asked" in peeks.told("/out", None)["problem"]
    seen = look(names)
    assert "not registered" in peeks.told("/nobody", seen)["problem"]
    out.close()
    assert peeks.told("/out", seen)["problem"]
    monkeypatch.setattr(dash_peek, "MOST", 0)
    assert "try later" in peeks.told("/out", seen)["problem"]
