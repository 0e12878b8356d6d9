"""Functions written line by line."""

from yarpy.data.generated import Code


def test_lines_and_names() -> None:
    code = Code()
    code.line("if x:")
    code.indent(1)
    code.line(f"return {code.name('yes')}")
    code.indent(-1)
    code.line(f"return {code.name('no', 'N')}")
    function = code.compiled("choose", "x")
    assert (function(True), function(False)) == ("yes", "no")
    assert all(name.startswith("_") for name in code.globals)


def test_nothing_to_do() -> None:
    assert Code().compiled("nothing", "")() is None


def test_numbers_side_by_side_are_one_run() -> None:
    code = Code()
    assert code.run() is None
    code.number("I", "a")
    code.number("II", "b", "c")
    found = code.run()
    assert found is not None
    assert (found[0].format, found[1]) == ("<III", ["a", "b", "c"])
    assert code.run() is None
    assert code.variable() != code.variable()
