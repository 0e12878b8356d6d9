"""How the graph cuts names that find no room: ports in front, programs in the middle."""

import subprocess
from pathlib import Path

import pytest
from support.peer import program
from support.wait import HANG

import yarpy.kits.views as views

ASSETS = Path(views.__file__).parent / "assets"
CALL = """
const context = {font: "x", measureText: (text) => ({width: text.length})};
console.log(cut(context, "/icub/cam/left", 8));
console.log(cut(context, "yarpy view --connect · 127.0.0.1", 20, true));
console.log(cut(context, "/a", 8));
"""
TITLE = """
console.log(titled({program: "/usr/bin/python3.11 /home/me/bin/yarpy view --connect", place: "h"}));
console.log(titled({program: "/usr/bin/yarpserver --write", place: "h"}));
console.log(titled({program: "/usr/bin/python3", place: "h"}));
"""


def said(file: str, begin: str, end: str, call: str) -> list[str]:
    """What a part of a script, from one text to another, and a call of it print."""
    whole = (ASSETS / file).read_text("utf-8")
    part = whole[whole.index(begin) :]
    part = part[: part.index(end)] if end else part
    command = [program("node"), "--eval", part + call]
    done = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=True)
    return done.stdout.splitlines()


@pytest.mark.peer("node")
def test_names_are_cut_in_front_and_programs_in_the_middle() -> None:
    assert said("dash_graph.js", "const widths = new Map();", "", CALL) == [
        "…am/left",
        "yarpy view…127.0.0.1",
        "/a",
    ]


@pytest.mark.peer("node")
def test_a_program_is_called_by_its_name_and_not_by_its_interpreter() -> None:
    assert said("dash.js", "function titled", "const network", TITLE) == [
        "yarpy view --connect · h",
        "yarpserver --write · h",
        "python3 · h",
    ]
