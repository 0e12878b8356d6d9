"""Settings from TOML, YAML, mappings and the environment; errors that name the place."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from support.wait import HANG

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.decorator import target

pytestmark = pytest.mark.usefixtures("names")


def arm() -> Any:
    """A class of its own for each test."""

    class Arm:
        @wrap.on("/arm/move")
        def move(self) -> int:
            return 1

        @wrap.on("/arm/ask")
        def ask(self) -> int:
            return 2

    return Arm


def test_toml(tmp_path: Path) -> None:
    before, file = arm()(), tmp_path / "arm.toml"
    file.write_text(
        '[Arm]\nask = "off"\n[Arm.move]\nmode = "publish"\ntopic = "/other"\ntimeout = 0.5\n'
        'qos = {packets = "HIGH"}\n'
    )
    wrap.configure(file)
    after = arm()()
    for one in (before, after):
        assert one.ask() is None and one.move() == 1
        assert yarpy.exists("/other") and not yarpy.exists("/arm/move")
        assert target(one.move)[0].timeout == 0.5
        wrap.off(one.move).close()
        assert not yarpy.exists("/other")


def test_files_of_wrapyfi(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    file = tmp_path / "arm.yml"
    file.write_text("Arm:\n  ask: disable\n  move: [null, disable, none]\n")
    wrap.configure(str(file))
    kind = arm()
    arms = [kind() for _ in range(5)]
    for _ in range(2):
        assert [one.move() for one in arms] == [1, None, 1, 1, 1]
    assert arms[0].ask() is None


def test_chosen_modes_count_more() -> None:
    wrap.configure({"Arm": {"move": "off"}})
    one = arm()()
    with wrap.publish(one.move):
        assert one.move() == 1
    assert one.move() is None


def test_module_may_be_named() -> None:
    wrap.configure({f"{__name__}.Arm": {"move": "off"}, "elsewhere.Arm": {"ask": "off"}})
    one = arm()()
    assert one.move() is None and one.ask() == 2


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"Arm": 3}, "Arm has no methods"),
        ({"Arm": {"move": "fly"}}, r'Arm.move: no mode "fly": take publish'),
        ({"Arm": {"move": {"mode": "off", "colour": 1}}}, r'Arm.move has "colour"; known are'),
        ({"Arm": {"move": {"qos": {"packets": "x"}}}}, r"Arm.move: qos: "),
    ],
)
def test_what_makes_no_sense(settings: Any, words: str) -> None:
    with pytest.raises(yarpy.LocalProtocolError, match=words):
        wrap.configure(settings)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(yarpy.MissingFile, match=r"no.toml cannot be read"):
        wrap.configure(tmp_path / "no.toml")
    for name, text in (("a.toml", "[x"), ("b.yml", "a: ["), ("c.yml", "[1]")):
        (tmp_path / name).write_text(text)
        with pytest.raises(yarpy.LocalProtocolError, match=name):
            wrap.configure(tmp_path / name)


def test_environment() -> None:
    code = """
from yarpy import wrap
class Arm:
    @wrap.on("/arm")
    def move(self): return 1
    @wrap.on("/arm2")
    def ask(self): return 2
print(Arm().move(), Arm().ask())
"""
    for text, said in (
        ("Arm.move=off; Arm.ask=none", "None 2"),
        ("Arm=off", "not Class.method=mode"),
    ):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True,
            timeout=HANG, env={**os.environ, "YARPY_WRAP": text},
        )  # fmt: skip
        assert said in done.stdout + done.stderr
