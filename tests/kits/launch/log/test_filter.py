"""Which lines of a log are shown."""

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.log.filter import Filter, expression, matches, program_of
from yarpy.port.keep.log_line import LogLine

LINE = LogLine("/log/vm/arm.py[left]/77", "WARNING", "joint 3 is Hot", 1.0, "my.arm")


@pytest.mark.parametrize(
    ("wanted", "shown"),
    [
        (Filter(), True),
        (Filter("WARNING"), True),
        (Filter("ERROR"), False),
        (Filter(program="arm"), True),
        (Filter(program="arm.py*"), True),
        (Filter(program="vm"), False),
        (Filter(component="my.*"), True),
        (Filter(component="your"), False),
        (Filter(grep=expression("joint [23] is hot")), True),
        (Filter(grep=expression("Joint")), False),
    ],
)
def test_lines(wanted: Filter, shown: bool) -> None:
    assert wanted.takes(LINE) is shown


def test_a_line_without_a_level_is_shown_at_every_level() -> None:
    assert Filter("FATAL").takes(LogLine("/log/vm/x/1", "", "plain"))


def test_programs_and_patterns() -> None:
    assert program_of("/log/nodeA/yarpdev/12") == "yarpdev" and program_of("odd") == "odd"
    assert matches("", "/x") and matches("/log/*/b", "/log/a/b") and not matches("*b", "bc")


def test_what_is_no_expression() -> None:
    assert expression("") is None
    with pytest.raises(LocalProtocolError, match="no regular expression"):
        expression("(")
