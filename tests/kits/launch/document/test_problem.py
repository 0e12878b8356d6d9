"""Places and problems as people read them."""

from yarpy.kits.launch.document.problem import Problem, Where


def test_places_and_problems_read_well() -> None:
    assert str(Where("a.xml", 3, 7)) == "a.xml:3:7"
    assert str(Where("a.xml", 3)) == "a.xml:3" and str(Where("a.xml")) == "a.xml"
    assert str(Problem(Where("a", 1, 2), "odd")) == "a:1:2: warning: odd"
    assert str(Problem(Where("a", 1, 2), "bad", True)) == "a:1:2: error: bad"
