"""Words of YARP 3: requests and answers as C++ has them, and what is refused."""

import pytest

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.depth import DepthCamera
from yarpy.kits.devices.interfaces.joypad import Joypad, Point
from yarpy.kits.devices.interfaces.world import Description, Descriptions
from yarpy.kits.devices.network import words
from yarpy.kits.devices.network.model import Member

DEPTH, PAD, ROBOT = DepthCamera.members, Joypad.members, Descriptions.members
EYE, ARM = Description("eye", "camera"), Description("arm", "board")


@pytest.mark.parametrize(
    ("each", "form", "values", "request_", "results", "answer"),
    [
        (PAD["button_count"], "ok", (), "[ijpc] [get] [butn] [cnt]", (4,), "[ok] 4"),
        (PAD["button"], "ok", (2,), "[ijpc] [get] [butn] [val] 2", (0.5,), "[ok] 0.5"),
        (PAD["trackball"], "ok", (0,), "[ijpc] [get] [trbl] [val] 0", (Point(1.0, 2.0),),
         "[ok] 1.0 2.0"),
        (PAD["stick"], "ok", (2, 0), "[ijpc] [get] [stck] [val] [polr] 2", (Point(1.0, 2.0), 0),
         "[ok] 1.0 2.0 0"),
        (PAD["touch"], "ok", (1,), "[ijpc] [get] [tuch] [val] 1", ([Point(1.0, 2.0), Point()],),
         "[ok] 1.0 2.0 0.0 0.0"),
        (ROBOT["devices"], "list", (), "[irob] [get] [all]", ([EYE, ARM],),
         "[ok] (eye camera arm board)"),
        (ROBOT["devices_of"], "list", ("x",), "[irob] [get] [type] x", ([],), "[ok] ()"),
        (ROBOT["register"], "list", (EYE,), "[irob] [set] [dev] eye camera", (), "[ok]"),
        (ROBOT["unregister"], "list", ("eye",), "[irob] [del] [dev] eye", (), "[ok]"),
        (DEPTH["depth_width"], "is", (), "[visd] [get] [w]", (320,), "[visd] [w] [is] 320"),
        (DEPTH["mirror_depth"], "is", (True,), "[visd] [set] [mirr] 1", (), "[visd] [set] 1"),
        (DEPTH["push"], "is", (3,), "[fgc] [set] [onep] 3", (), "[nak]"),
        (DEPTH["clip_planes"], "is", (), "[visd] [get] [clip]", (0.2, 8.0),
         "[visd] [clip] [is] 0.2 8.0"),
    ],
)  # fmt: skip
def test_both_ways(
    each: Member, form: str, values: tuple[object, ...], request_: str, results: tuple[object, ...],
    answer: str,
) -> None:  # fmt: skip
    request = words.question(each, values)
    assert request == Bottle.from_text(request_)
    members = [*{"ok": PAD, "is": DEPTH, "list": ROBOT}[form].values()]
    assert words.asked(members, request) is each
    assert words.arguments(each, request) == values
    found = words.answer(each, form, results)
    assert found == Bottle.from_text(answer)
    assert words.results(each, form, found) == results
    failed = words.answer(each, form, None)
    assert words.results(each, form, failed) is None


def test_what_servers_of_cpp_leave_out_or_add() -> None:
    found = words.results(PAD["stick"], "ok", Bottle.from_text("[ok] 1.0 2.0"))
    assert found == (Point(1.0, 2.0), 0)
    found = words.results(PAD["touch"], "ok", Bottle.from_text("[ok] 10.0 11.0 12.0"))
    assert found == ([Point(10.0, 11.0)],)
    assert words.results(PAD["button"], "ok", Bottle()) is None
    with pytest.raises(DecodeError, match="expected one of polr cart, got 'x'"):
        words.arguments(PAD["stick"], Bottle.from_text("[ijpc] [get] [stck] [val] [x] 2"))


def test_what_is_about_no_member() -> None:
    request = Bottle.from_text("[rgdb] [get] [prot]")
    found = words.fixed(DepthCamera.TOLD, request)
    assert found == Bottle.from_text("[rgdb] [prot] [is] 1 0")
    assert words.fixed(Joypad.TOLD, request) is None
    assert words.fixed(DepthCamera.TOLD, Bottle.from_text("[rgdb] [get]")) is None


def test_nobody_is_meant() -> None:
    for text in ("[ijpc]", "[visd] [get]", "[visd] [get] [bogu]", "hello", "1 2 3", "[get] [axis]"):
        assert words.asked(DEPTH.values(), Bottle.from_text(text)) is None


@pytest.mark.parametrize("text", ["[fgc] [get] [feat]", "[fgc] [get] [feat] hello"])
def test_bad_arguments(text: str) -> None:
    with pytest.raises(DecodeError):
        words.arguments(DEPTH["feature"], Bottle.from_text(text))


def test_bad_answers() -> None:
    with pytest.raises(DecodeError):
        words.results(DEPTH["depth_width"], "is", Bottle.from_text("[visd] [w] [is] hello"))
    with pytest.raises(DecodeError):
        words.results(DEPTH["configurations"], "is", Bottle.from_text("[visr] [conf] [is] 900"))
    # A server that says less than others.
    assert words.results(DEPTH["clip_planes"], "is", Bottle([])) == (0.0, 0.0)
