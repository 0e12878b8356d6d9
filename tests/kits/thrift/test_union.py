"""Unions and exceptions."""

import pytest
from support.thrift_module import apache

from yarpy.kits import thrift


def test_a_field_of_a_union_is_set() -> None:
    m = apache()
    found = m.Shape(radius=2.0)
    assert issubclass(m.Shape, thrift.Union) and (found.side, found.radius) == (None, 2.0)
    assert found.to_text() == "0 2.0"  # on YARP's wire all of them are there


def test_an_exception_can_be_raised() -> None:
    m = apache()
    with pytest.raises(m.Bad, match="bad") as caught:
        raise m.Bad(5, "bad")
    assert caught.value == m.Bad(5, "bad") and isinstance(caught.value, thrift.Error)
    assert str(m.Worse("so")) == "Worse(why='so')" and hash(m.Bad()) == hash(m.Bad())
    assert m.Bad.from_bottle([5, "bad"]).code == 5


def test_names_that_exceptions_have_are_others() -> None:
    m = thrift.loads("exception E { 1: list<string> args }")
    found = m.E(args_=["a"])
    assert found.to_dict() == {"args": ["a"]} and found.args == ()
