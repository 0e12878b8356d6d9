"""What is asked, word for word, and what is made of the answers."""

import pytest

from yarpy.errors import LocalProtocolError, RemoteProtocolError, UnknownName
from yarpy.kits.devices.control_board.requests import Requests

# member, reply to the request(s) that it becomes, values
READ = [
    ("axis_names", ["[get] [name] {}"], "[is] [name] pan [tsta] 0 1.0 [ok]", ["pan"] * 3),
    ("axis_types", ["[get] [type] {}"], "[is] [type] 1919972449 [tsta] 0 1.0 [ok]",
     ["prismatic"] * 3),
    ("axis_types", ["[get] [type] {}"], "[is] [type] 1 [tsta] 0 1.0 [ok]", ["unknown"] * 3),
    ("position_targets", ["[get] [poss]"], "[is] poss (1.0 2.0 3.0) [tsta] 5 1.0 [ok]",
     [1.0, 2.0, 3.0]),
    ("motion_done", ["[get] [don] {}"], "[is] [don] 1 [tsta] 0 1.0 [ok]", [True] * 3),
    ("position_limits", ["[get] [llim] {}"], "[is] [llim] -5 5.5 [tsta] 0 1.0 [ok]",
     [(-5.0, 5.5)] * 3),
    ("torque_ranges", ["[get] [torq] [rngs]"],
     "[is] [torq] (1.0 2.0 3.0) (4.0 5.0 6.0) [tsta] 0 1.0 [ok]",
     [(1.0, 4.0), (2.0, 5.0), (3.0, 6.0)]),
    ("current_ranges", ["[get] [icur] [rngs]"], "[is] [icur] (1.0 2.0 3.0) (4.0 5.0 6.0) [ok]",
     [(1.0, 4.0), (2.0, 5.0), (3.0, 6.0)]),
    ("control_modes", ["[get] [icmd] [cmds]"],
     "[is] [cmds] ([pos] [vel] [posd]) [tsta] 0 1.0 [ok]", ["pos", "vel", "posd"]),
    ("interaction_modes", ["[get] [intm] [mods]"], "([stif] [comp] [stif]) [tsta] 0 1.0 [ok]",
     ["stif", "comp", "stif"]),
    ("faults", ["[get] [ijfl] [jhfl] {}"], '[is] 3 "too hot" [ok]', [(3, "too hot")] * 3),
    ("impedances", ["[get] [iimp] [ipr] {}"], "[is] [iimp] (1.0 2.0) [tsta] 0 1.0 [ok]",
     [(1.0, 2.0)] * 3),
    ("impedance_offsets", ["[get] [iimp] [iof] {}"], "[is] [iimp] (1.5) [tsta] 0 1.0 [ok]",
     [1.5] * 3),
    ("amplifier_status", ["[get] [asta]"], "[is] asta (1 2 3) [tsta] 0 1.0 [ok]", [1, 2, 3]),
    ("supply_voltages", ["[get] [avsu] {}"], "[is] [avsu] 24.0 [tsta] 0 1.0 [ok]", [24.0] * 3),
]  # fmt: skip


@pytest.mark.parametrize(("member", "requests", "reply", "values"), READ)
def test_reading(parrot, ask, member, requests, reply, values):
    asked = [text.format(joint) for text in requests for joint in range(3)]
    asked = asked if "{}" in requests[0] else requests
    parrot.answers.update(dict.fromkeys(asked, reply))
    assert ask.read(member) == values
    assert parrot.heard == asked


WRITTEN = [
    ("position_move", [1], [4.5], ["[set] [pos] 1 4.5"]),
    ("position_move", [0, 1, 2], [1.0, 2.0, 3.0], ["[set] [poss] (1.0 2.0 3.0)"]),
    ("position_move", [2, 0], [1.0, 2.0], ["[set] [posg] 2 (2 0) (1.0 2.0)"]),
    ("stop", [1], None, ["[set] [sto] 1"]),
    ("stop", [0, 1, 2], None, ["[set] [stos]"]),
    ("stop", [0, 1], None, ["[set] [stog] 2 (0 1)"]),
    ("preset_encoders", [0, 1], [1.0, 2.0], ["[set] [enc] 0 1.0", "[set] [enc] 1 2.0"]),
    ("switch_control_modes", [1], ["vel"], ["[set] [icmd] [cmod] 1 [vel]"]),
    ("switch_control_modes", [0, 1, 2], ["vel", "pos", "idl"],
     ["[set] [icmd] [cmds] ([vel] [pos] [idl])"]),
    ("switch_interaction_modes", [0, 2], ["stif", "comp"],
     ["[set] [intm] [modg] 2 (0 2) ([stif] [comp])"]),
    ("position_limits", [0, 1, 2], [(0.0, 1.0)] * 3,
     [f"[set] [llim] {joint} 0.0 1.0" for joint in range(3)]),
    ("impedances", [1], [(0.5, 0.25)], ["[set] [iimp] [ipr] 1 (0.5 0.25)"]),
    ("impedance_offsets", [1], [0.5], ["[set] [iimp] [iof] 1 (0.5)"]),
    ("enable_amplifiers", [0, 1], None, ["[set] [aen] 0", "[set] [aen] 1"]),
]  # fmt: skip


@pytest.mark.parametrize(("member", "joints", "values", "asked"), WRITTEN)
def test_writing(parrot, ask, member, joints, values, asked):
    ask.write(member, joints, values)
    assert parrot.heard == asked


def test_calibration(parrot, ask):
    parrot.answers["[cald] 1"] = "[fail]"
    assert ask.calibration_done(0) and not ask.calibration_done(1)
    ask.calibrate_joint(0, 5, [1, 2, 3])
    ask.calibrate_joint(0, 5, [1, 2, 3, 4])
    ask.calibrator("calibrate", [0, 1, 2])
    ask.calibrator("home", [1, 2])
    ask.calibrator("quit_parking", [])
    assert parrot.heard == [
        "[cald] 0",
        "[cald] 1",
        "[calj] 0 5 1.0 2.0 3.0",
        "[cljp] 0 5 1.0 2.0 3.0 4.0",
        "[set] [reca] [cals]",
        "[set] [reca] [hom] 1",
        "[set] [reca] [hom] 2",
        "[set] [reca] [qupa]",
    ]
    with pytest.raises(ValueError, match="3 or 4"):
        ask.calibrate_joint(0, 5, [1, 2])


@pytest.mark.parametrize(
    ("reply", "version"),
    [("[prot] 1 9 0 [ok]", (1, 9, 0)), ("[prot] 2 0 0 [ok]", (2, 0, 0)), ("[fail]", ()),
     ("[ok]", ()), ("", ()), ("[prot] 1 9 x [ok]", (1, 9)), ("5", ())],
)  # fmt: skip
def test_versions(parrot, ask, reply, version):
    parrot.answers["[get] [prot]"] = reply
    assert ask.version() == version


@pytest.mark.parametrize(
    "reply",
    ["[nak]", "", "5", "[is] [poss] [ok]", "[is] [poss] 5 [tsta] 0 1.0 [ok]",
     "[is] [poss] (1.0 2.0) [tsta] 0 1.0 [ok]", "[is] [poss] (a b c) [tsta] 0 1.0 [ok]",
     "[ok]"],
)  # fmt: skip
def test_answers_that_make_no_sense(parrot, ask, reply):
    parrot.answers["[get] [poss]"] = reply
    with pytest.raises(RemoteProtocolError, match="/head"):
        ask.read("position_targets")


def test_refusals(parrot, ask):
    parrot.answers["[set] [pos] 1 99.0"] = "[fail]"
    with pytest.raises(LocalProtocolError, match=r'"/head" refuses \[set\] \[pos\] 1 99.0'):
        ask.write("position_move", [1], [99.0])
    with pytest.raises(AttributeError, match="only be read"):
        ask.write("torque_ranges", [0], [(1.0, 2.0)])


@pytest.mark.parametrize("reply", ["[is] [axes] 0 [ok]", "[is] [axes] x [ok]", "[ok]"])
def test_how_many_joints(parrot, ask, reply):
    parrot.answers["[get] [axes]"] = reply
    with pytest.raises(RemoteProtocolError, match="how many joints"):
        ask.count_axes()


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        Requests("/nobody", "/me", names)
