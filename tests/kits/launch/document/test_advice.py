"""Advice about words that are not known."""

import pytest

from yarpy.kits.launch.application.vocabulary import CONNECTION, MODULE, ROOT
from yarpy.kits.launch.document.advice import advice


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("moduel", ROOT, "module"),
        ("dependecies", ROOT, "dependencies"),
        ("parameter", MODULE, "parameters"),
        ("Node", MODULE, "node"),
        ("protocoll", CONNECTION, "protocol"),
        ("xyz", CONNECTION, ""),
    ],
)
def test_advice(word: str, known: tuple[str, ...], meant: str) -> None:
    said = advice(word, known)
    assert f'"{meant}"' in said if meant else said == ""
