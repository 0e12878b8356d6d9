"""What differs between two descriptions."""

from dataclasses import replace

from yarpy.kits.launch.application.application import Application, Connection, Module, Need
from yarpy.kits.launch.document.problem import Where
from yarpy.kits.launch.supervise.difference import Difference, difference

A = Module("a", "sleep", "1", needs=[Need("/p", where=Where("f", 3, 1))], where=Where("f", 2, 1))
LINK = Connection("/a", "/b", where=Where("f", 9, 1))


def app(*modules: Module, links: tuple[Connection, ...] = ()) -> Application:
    return Application("app", modules=[*modules], connections=[*links])


def test_a_place_is_no_difference() -> None:
    moved = replace(A, where=Where("g", 5, 5), needs=(Need("/p", where=Where("g", 1, 1)),))
    link = replace(LINK, where=Where("g", 1, 1))
    found = difference(app(A, links=(LINK,)), app(moved, links=(link,)))
    assert found == Difference() and [*found.texts()] == []


def test_what_is_new_gone_or_other() -> None:
    before = app(A, Module("b", "x"), links=(LINK,))
    after = app(replace(A, parameters="2"), Module("c", "x"), links=(Connection("/a", "/c"),))
    found = difference(before, after)
    assert (found.new, found.gone, found.other) == (("c",), ("b",), ("a",))
    assert [one.label for one in found.made] == ["/a -> /c"]
    assert [*found.texts()] == [
        "c is new",
        "b is no longer in the file",
        "a is described otherwise, and was started again",
        "/a -> /c is new",
        "/a -> /b is no longer in the file",
    ]
