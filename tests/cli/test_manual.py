"""The manual page is what the verbs say today, and man understands it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from support.peer import program

from yarpy.cli.main import root
from yarpy.cli.manual import _text, manual
from yarpy.cli.verb_list import VERBS

PAGE = Path(__file__).parents[2] / "docs" / "yarpy.1"


def test_page_in_docs_is_what_the_verbs_say() -> None:
    assert PAGE.read_text() == manual(root), "make it anew: yarpy help --man > docs/yarpy.1"


def test_every_verb_has_its_section() -> None:
    sections = {line[4:] for line in manual(root).splitlines() if line.startswith(".SS ")}
    assert sections == set(VERBS)


def test_defaults_are_shown_and_true() -> None:
    page = manual(root)
    assert "[default: 30.0; 0.1<=x<=1000.0]" in page
    assert "The port number.  [default: (as stored, else 10000); 0<=x<=65535]" in page
    assert 'default: ""' not in page and "default: ...]" not in page


@pytest.mark.peer("man")
def test_man_shows_it_without_a_warning() -> None:
    done = subprocess.run(
        [program("man"), "--warnings", "--encoding=UTF-8", "-l", PAGE],
        capture_output=True, text=True, timeout=60, env={"MANWIDTH": "80", "PATH": "/usr/bin:/bin"},
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert "yarpy connect /talker /listener fast_tcp" in done.stdout


def test_nothing_is_a_request_by_accident() -> None:
    assert _text(".x\n'y\n\\z --a") == "\\&.x\n\\&'y\n\\ez \\-\\-a"
