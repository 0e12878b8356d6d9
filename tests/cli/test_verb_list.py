"""The table of verbs: what tests/cli/test_main.py does not ask of it."""

from __future__ import annotations

import pytest

from yarpy.cli.verb_list import GROUPS, VERBS


@pytest.mark.parametrize("verb", VERBS)
def test_a_line_says_it(verb: str) -> None:
    about = VERBS[verb].about
    assert len(about) < 80 and not about.endswith(".") and about[0].islower()


def test_each_verb_is_in_one_group() -> None:
    assert len(VERBS) == sum(map(len, GROUPS.values()))
