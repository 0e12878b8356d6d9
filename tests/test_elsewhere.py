"""Names of YARP's bindings, looked for in `yarpy`."""

import re

import pytest

import yarpy
from yarpy import elsewhere


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Network", "nothing has to be initialised"),
        ("BufferedPortImageRgb", "yarpy.BufferedPort is for messages of every type"),
        ("ImageRgb", "yarpy.Image is of every kind of pixel"),
        ("RFModule", "yarpy.Module"),
        ("Publisher", r"yarpy.Port\(name\) writes to all"),
    ],
)
def test_a_name_of_the_bindings_is_told_what_takes_its_place(name: str, said: str) -> None:
    with pytest.raises(AttributeError, match=f"no attribute '{name}': {said}.*`import yarp`"):
        getattr(yarpy, name)


def test_what_takes_their_place_exists() -> None:
    for said in elsewhere._INSTEAD.values():
        for path in re.findall(r"yarpy((?:\.\w+)+)", said):
            found = yarpy
            for part in path.strip(".").split("."):
                found = getattr(found, part)


@pytest.mark.parametrize("name", ["Nothing", "imagine", "Logs", "__wrapped__"])
def test_any_other_name_gets_no_such_answer(name: str) -> None:
    assert elsewhere.instead(name) == ""
    assert not hasattr(yarpy, name)
