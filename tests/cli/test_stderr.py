"""Complaints are one line, on standard error."""

import pytest

from yarpy.cli.stderr import complain, warn


@pytest.mark.parametrize(
    ("say", "text", "line"),
    [
        (complain, "it broke", "error: it broke\n"),
        (complain, "a\n  longer\tstory\n", "error: a longer story\n"),
        (warn, "odd", "warning: odd\n"),
    ],
)
def test_one_line(capsys, say, text, line):
    say(text)
    assert capsys.readouterr() == ("", line)
