"""A terminal for a program on another computer: tests/kits/launch/verbs/test_run.py has a whole
one."""

import pytest

from yarpy.errors import UnknownName
from yarpy.kits.launch.run import terminal
from yarpy.testing import private_names


def test_there_is_no_such_program() -> None:
    with private_names(), pytest.raises(UnknownName):
        terminal.attach("/node/1/x-1")
