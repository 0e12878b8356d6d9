"""The table of verbs: what tests/cli/test_main.py does not ask of it."""

from __future__ import annotations

import click
import pytest
from support.table import for_each

from yarpy.cli.main import find_verb
from yarpy.cli.verb_list import GROUPS, VERBS


@for_each(VERBS)
def test_a_line_says_it(verb: str) -> None:
    about = VERBS[verb].about
    assert len(about) < 80 and not about.endswith(".") and about[0].islower()


def test_each_verb_is_in_one_group() -> None:
    assert len(VERBS) == sum(map(len, GROUPS.values()))


@pytest.mark.parametrize("verb", VERBS)
def test_lists_of_commands_are_not_cut_off(verb: str) -> None:
    """What `yarpy VERB --help` says of each command of a group fits into 80 columns."""
    command = find_verb(verb)
    if not isinstance(command, click.Group):
        return
    with click.Context(command, info_name=verb, terminal_width=80) as context:
        _, _, listed = command.get_help(context).partition("Commands:")
    assert listed and "..." not in listed
