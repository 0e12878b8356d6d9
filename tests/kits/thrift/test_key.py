"""Values as keys."""

import numpy as np

from yarpy.kits.thrift.key import Pairs, fingerprint, frozen


def test_what_changes_becomes_what_does_not() -> None:
    assert frozen([1, [2]]) == (1, (2,)) and frozen(np.array([1.5])) == (1.5,)
    assert frozen({1, 2}) == frozenset((1, 2)) and frozen("a") == "a"
    found = frozen({1: [2]})
    assert found == {1: (2,)} and isinstance(found, Pairs)
    assert {found: "x"}[Pairs({1: (2,)})] == "x"


def test_a_fingerprint_is_of_what_is_in_it() -> None:
    assert fingerprint([1, {2}]) == fingerprint((1, frozenset((2,))))
    assert fingerprint(np.array([1.0, 2.0])) == fingerprint([1.0, 2.0])
    assert fingerprint({"a": [1]}) == fingerprint({"a": np.array([1])})
    assert fingerprint([1]) != fingerprint([2])
