"""Structs of devices: places in maps, lines of conversations."""

from __future__ import annotations

import math

import pytest

import yarpy


def test_place_on_the_wire_and_back() -> None:
    import yarp

    place, found = yarp.Map2DLocation("hall", 1, -2.5, 90.0, "at the door"), yarp.Map2DLocation()
    # As C++ YARP 3.6 and later write the struct: a list of five, each with its tag.
    assert place._outgoing().to_wire()[0] == bytes.fromhex(
        "00010000 05000000 04000000 04000000 68616c6c 0a000000 000000000000f03f"
        "0a000000 00000000000004c0 0a000000 0000000000805640 04000000 0b000000"
        "617420746865 20646f6f72"
    )
    assert yarp.Portable.copyPortable(place, found)
    assert (found.map_id, found.x, found.y, found.theta) == ("hall", 1.0, -2.5, 90.0)
    assert found.description == "at the door"
    assert found.toString() == "map_id:hall x:1 y:-2.5 theta:90desc:at the door"
    copy = yarp.Map2DLocation(found)
    copy.description = ""
    assert copy == found and copy != yarp.Map2DLocation() and copy != "hall"


def test_place_of_yarp_3_5_has_no_description() -> None:
    import yarp

    found = yarp.Map2DLocation("", 0, 0, 0, "old")
    assert yarp.Portable.copyPortable(yarp.Bottle("hall 1.0 2.0 3.0"), found)
    assert (found.map_id, found.y, found.description) == ("hall", 2.0, "")
    assert not yarp.Portable.copyPortable(yarp.Bottle("hall 1.0"), found)
    assert found.x == 1.0


@pytest.mark.parametrize(
    ("theta", "turn", "near"),
    [(179.0, 3.0, True), (-535.0, 7.0, True), (90.0, 10.0, False), (90.0, math.inf, True)],
)
def test_how_near_places_are(theta: float, turn: float, near: bool) -> None:
    import yarp

    here = yarp.Map2DLocation("hall", 0, 0, -180)
    assert here.is_near_to(yarp.Map2DLocation("hall", 3, 4, theta), 5.0, turn) is near
    assert not here.is_near_to(yarp.Map2DLocation("hall", 3, 4, theta), 4.9, turn)
    assert not here.is_near_to(yarp.Map2DLocation("roof", 0, 0, -180), 1.0, 1.0)
    assert not here.is_near_to(here, -1.0, 1.0)


def test_conversation() -> None:
    import yarp

    line = yarp.LLM_Message("function", "move", yarp.SVector(["where"]), ["left"])
    found = yarp.LLM_Message()
    assert yarp.Portable.copyPortable(line, found)
    assert found.toString() == "function move (where) (left)"
    assert (found.type, found.parameters, found.arguments) == ("function", ["where"], ["left"])
    talk = yarp.LLMVector(2)
    talk[0].content = "hello"
    talk.push_back(found)
    talk.resize(4)
    assert [one.content for one in talk] == ["hello", "", "move", ""]
    with pytest.raises(TypeError, match="LLM_Message is needed"):
        talk.push_back("hello")
    assert [*yarp.Map2DLocationVector(1)] == [yarp.Map2DLocation()]


def test_place_goes_over_ports() -> None:
    import yarp

    yarp.Network.setLocalMode(True)
    out, inp = yarp.Port(), yarp.Port()
    try:
        assert inp.open("/place/in") and out.open("/place/out")
        assert yarp.Network.connect("/place/out", "/place/in", "tcp")
        assert out.write(yarp.Map2DLocation("hall", 1, 2, 3))
        found = yarp.Map2DLocation()
        assert inp.read(found) and found == yarp.Map2DLocation("hall", 1, 2, 3)
        out.write(yarp.Bottle("nothing of the kind"))
        assert not inp.read(found) and found.x == 1.0
    finally:
        out.close()
        inp.close()
        yarp.Network.setLocalMode(False)


def test_status_of_navigation_is_a_vocab() -> None:
    import yarp

    assert yarp.navigation_status_idle == yarpy.Vocab("idle").code
    assert yarp.Vocab_decode(yarp.navigation_status_goal_reached) == "rech"
    assert yarp.Vocab_encode("idle") == yarp.Vocab.encode("idle") == yarp.navigation_status_idle


def test_wrong_index_of_a_bottle_says_so() -> None:
    import yarp

    with pytest.raises(TypeError, match="an index is an integer, not 'x'"):
        yarp.Bottle("1 2").get("x")
