"""The contract of runners: a program is a value, and what is written against it type-checks."""

from yarpy.kits.launch.supervise.runner import Program


def test_a_program_needs_a_name_and_a_command() -> None:
    program = Program("a", ["sleep", "1"])
    assert (program.workdir, dict(program.environment), program.host) == ("", {}, "")
    assert program == Program("a", ["sleep", "1"]) != Program("b", ["sleep", "1"])
