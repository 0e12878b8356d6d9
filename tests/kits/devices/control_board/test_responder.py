"""Requests and replies: those of the specification, those recorded, and nonsense."""

import itertools
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.board import Bare, FakeBoard
from support.capture import load_capture
from support.replay import messages_of

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.control_board import grammar
from yarpy.kits.devices.control_board.board import Board
from yarpy.kits.devices.control_board.grammar import INTERFACES, PID, Form, lookup
from yarpy.kits.devices.control_board.responder import Responder

STAMP = re.compile(r"\[tsta\] (\d+) [\d.]+ ")


def answers(device):
    responder = Responder(Board(device, "/head"))
    return lambda text: responder.answer(Bottle.from_text(text))


def texts(device):
    """Replies as text, times blanked."""
    answer = answers(device)
    return lambda text: STAMP.sub(r"[tsta] \1 t ", answer(text).to_text())


# The table of the specification, in order, for four joints: the counter counts the questions.
SPEC = [
    ("get axes", "[is] axes 4 [tsta] 0 t [ok]"),
    ("get encs", "[is] encs (0.0 0.0 0.0 0.0) [tsta] 1 t [ok]"),
    ("[get] [encs]", "[is] [encs] (0.0 0.0 0.0 0.0) [tsta] 2 t [ok]"),
    ("get enc 0", "[is] enc 0.0 [tsta] 3 t [ok]"),
    ("set pos 1 45", "[ok]"),
    ("get pos 1", "[is] pos 45.0 [tsta] 4 t [ok]"),
    ("set poss (1 2 3)", "[fail]"),
    ("set pos 9 45", "[fail]"),
    ("get don 1", "[is] don 1 [tsta] 5 t [ok]"),
    ("get dons", "[is] dons 1 [tsta] 6 t [ok]"),
    ("get dong 2 (1 3)", "[is] dong 1 [tsta] 7 t [ok]"),
    ("set icmd cmod 1 vel", "[ok]"),
    ("get icmd cmod 1", "[is] 1 [vel] [tsta] 8 t [ok]"),
    ("get icmd cmds", "[is] [cmds] ([pos] [vel] [pos] [pos]) [tsta] 9 t [ok]"),
    ("get icmd cmog 2 (1 2)", "[is] [cmog] ([vel] [pos]) [tsta] 10 t [ok]"),
    ("set icmd cmods (pos pos)", "[fail]"),
    ("set icmd cmds (pos pos)", "[fail]"),
    ("set icmd cmds (pos pos vel pos)", "[ok]"),
    ("set icmd cmog 2 (0 1) (torq idl)", "[ok]"),
    ("set icmd cmod 0 bogus", "[ok]"),
    ("set icmd bogus 0 vel", "[ok]"),
    ("set icmd bogus 0 blah", "[fail]"),
    ("get icmd cmds", "[is] [cmds] ([vel] [idl] [vel] [pos]) [tsta] 11 t [ok]"),
    ("set intm mode 0 comp", "[ok]"),
    ("get intm mode 0", "[comp] [tsta] 12 t [ok]"),
    ("get intm mods", "([comp] [stif] [stif] [stif]) [tsta] 13 t [ok]"),
    ("get intm modg 2 (0 1)", "([comp] [stif]) [tsta] 14 t [ok]"),
    ("get llim 0", "[is] llim -30.0 30.0 [tsta] 15 t [ok]"),
    ("get name 0", "[is] name joint0 [tsta] 16 t [ok]"),
    ("get type 0", "[is] type 1987212385 [tsta] 17 t [ok]"),
    ("get pid pid pos 0", "[is] pid (1.0 2.0 3.0 4.0 5.0 6.0 7.0 8.0 9.0 10.0) [ok]"),
    ("get ijfl jhfl 0", '[is] 0 "" [ok]'),
    ("get ijfl jhfl 1", '[is] 1 "test1 torque" [ok]'),
    ("get prot", "[prot] 1 9 0 [ok]"),
    ("set prot", "[fail]"),
    ("get icmd bogus", "[tsta] 18 t [ok]"),
    ("get torq bogus", "[fail]"),
    ("get bogus", "[fail]"),
    ("bogus bogus", "[fail]"),
    ("get axes", "[is] axes 4 [tsta] 21 t [ok]"),
    ("bogus", "[nak]"),
    ("help", "[nak]"),
    ("set", "[nak]"),
    ("", "[nak]"),
    # single values in all their forms
    ("get mnum", "[is] mnum 4 [tsta] 22 t [ok]"),
    ("get mtnm", "[is] mtnm 4 [tsta] 23 t [ok]"),
    ("get asts 2", "[is] asts 2 [tsta] 24 t [ok]"),
    ("get asta", "[is] asta (0 1 2 3) [tsta] 25 t [ok]"),
    ("get tmps", "[is] tmps (40.0 41.0 42.0 43.0) [tsta] 26 t [ok]"),
    # torques
    ("get torq trqs", "[is] torq (0.0 0.0 0.0 0.0) [tsta] 27 t [ok]"),
    ("get [torq] trq 0", "[is] [torq] 0.0 [tsta] 28 t [ok]"),
    ("get torq rng 1", "[is] torq -6.0 5.0 [tsta] 29 t [ok]"),
    ("get torq rngs", "[is] torq (-5.0 -6.0 -7.0 -8.0) (5.0 5.0 5.0 5.0) [tsta] 30 t [ok]"),
    ("get torq mtps 0", "[is] torq (0.0 1.0 2.0 3.0 4.0 5.0 6.0 7.0 8.0) [tsta] 31 t [ok]"),
    ("set torq mtps 0 (1 2 3 4 5 6 7 8)", "[fail]"),
    ("set torq mtps 0 (1 2 3 4 5 6 7 8 9)", "[ok]"),
    ("set torq ref 0 0.5", "[ok]"),
    ("get torq refs", "[is] torq (0.5 0.0 0.0 0.0) [tsta] 32 t [ok]"),
    ("set torq refs (1 2 3)", "[fail]"),
    ("set torq trqd", "[ok]"),
    ("get icmd cmds", "[is] [cmds] ([torq] [torq] [torq] [torq]) [tsta] 33 t [ok]"),
    # controllers, without a time
    ("set pid ref pos 1 3", "[ok]"),
    ("get pid refs pos", "[is] pid (0.0 3.0 0.0 0.0) [ok]"),
    ("get pid err pos 1", "[is] pid 0.5 [ok]"),
    ("get pid outs trq", "[is] pid (0.25 0.25 0.25 0.25) [ok]"),
    ("get pid lims cur", "[is] pid (5.0 5.0 5.0 5.0) [ok]"),
    ("set pid dis pos 0", "[ok]"),
    ("get pid ena pos 0", "[is] pid 0 [ok]"),
    ("set pid ena pos 0", "[ok]"),
    ("get pid ena pos 0", "[is] pid 1 [ok]"),
    ("set pid res pos 2", "[ok]"),
    ("set pid off pos 2 1.5", "[ok]"),
    ("set pid pid vel 0 (0 0 0 0 0 0 0 0 0)", "[fail]"),
    ("get pid pid bogus 0", "[fail]"),
    ("get pid bogus pos 0", "[fail]"),
    # impedance: lists, and a word that elsewhere means limits
    ("get iimp ipr 0", "[is] iimp (0.5 0.25) [tsta] 34 t [ok]"),
    ("get iimp iof 0", "[is] iimp (0.0) [tsta] 35 t [ok]"),
    ("get iimp llim 0", "[is] iimp (0.0 1.0 0.0 0.5) [tsta] 36 t [ok]"),
    ("set iimp ipr 0 (0.25 0.125)", "[ok]"),
    ("set iimp iof 0 (0.5)", "[ok]"),
    ("get iimp ipr 0", "[is] iimp (0.25 0.125) [tsta] 37 t [ok]"),
    # currents and PWM are streamed; they can only be asked for
    ("get icur ref 0", "[is] icur 0.0 [ok]"),
    ("get icur refs", "[is] icur (0.0 0.0 0.0 0.0) [ok]"),
    ("get icur rng 1", "[is] icur -2.0 3.0 [ok]"),
    ("get icur rngs", "[is] icur (-2.0 -2.0 -2.0 -2.0) (2.0 3.0 4.0 5.0) [ok]"),
    ("set icur ref 0 1.0", "[fail]"),
    ("get ipwm pwm 0", "[is] ipwm 33.0 [ok]"),
    ("get ipwm pwms", "[is] ipwm (0.0 0.0 0.0 0.0) [ok]"),
    ("set ipwm ref 0 1.0", "[fail]"),
    ("set vmo 0 1.0", "[fail]"),
    ("set dpo 0 1.0", "[fail]"),
    ("set dpos (1 2 3 4)", "[fail]"),
    ("set vmos (1 2 3 4)", "[ok]"),
    ("get vmog 2 (0 3)", "[is] vmog (1.0 4.0) [tsta] 38 t [ok]"),
    # variables and the calibrator
    ("get ivar lvar", "[is] ivar (gain limit) [ok]"),
    ("get ivar mvar gain", "[is] ivar (1.5 low) [ok]"),
    ("get ivar mvar limit", "[is] ivar (7) [ok]"),
    ("set ivar mvar gain 1 (2 x)", "[ok]"),
    ("get ivar mvar gain", "[is] ivar (1 (2 x)) [ok]"),
    ("get ivar mvar nothing", "[fail]"),
    ("set ivar mvar nothing 1", "[fail]"),
    ("get ivar mvar", "[fail]"),
    ("get reca isca", "[is] reca 1 [ok]"),
    ("set reca cal 1", "[ok]"),
    ("set reca homs", "[ok]"),
    ("set reca qupa", "[ok]"),
    ("set reca blah", "[fail]"),
    ("calj 0 1 2 3 4", "[ok]"),
    ("calj 0 1 2", "[fail]"),
    ("cljp 0 1 2 3 4 5", "[ok]"),
    ("cald 0", "[ok]"),
    ("cald 1", "[fail]"),
    ("park 1", "[ok]"),
    ("cal", "[nak]"),
    ("cal all", "[ok]"),
]


def test_replies():
    ask = texts(FakeBoard(4))
    for request, reply in SPEC:
        assert (request, ask(request)) == (request, reply)


def test_vocabs_and_strings_mean_the_same():
    plain, vocabs = answers(FakeBoard(4)), answers(FakeBoard(4))
    for request, _ in SPEC:
        spoken = Bottle.from_text(request)
        spelled = Bottle(Vocab(e) if type(e) is str and len(e) <= 4 else e for e in spoken)
        one, other = plain(spoken.to_text()), vocabs(spelled.to_text())
        assert len(one) == len(other) and one[-1] == other[-1], request


@pytest.mark.parametrize("name", ["mc_rpc_text", "mc_rpc_yarp_tool"])
def test_recorded_requests(name):
    """Every reply of the recorded board has the same elements; its joints were named from 1."""
    capture = load_capture(name)
    carrier, messages = messages_of(capture)
    device = FakeBoard(3)
    device.axis_names = ["joint1", "joint2", "joint3"]
    device.where = [3.5 if name == "mc_rpc_text" else 5.0, 0.0, 0.0]
    responder = Responder(Board(device, "/cap/mc"))
    responder._count = itertools.count(5 if name == "mc_rpc_text" else 13)
    replies = [step.data for step in capture.steps[2:] if step.sender == "b"]
    asking = [message for message in messages if message.key == "d"]
    assert len(asking) == len(replies) - (name == "mc_rpc_yarp_tool")
    for message, data in zip(asking, replies, strict=False):
        request = message.as_(Bottle)
        if request == ["help", "more"]:
            continue  # ours lists more, in other words
        theirs = (
            Bottle.from_bytes(data)
            if carrier.spelling == "binary"
            else Bottle.from_text(data.decode().partition("\r\n")[0])
        )
        ours = responder.answer(request)
        if "tsta" in theirs:
            ours[theirs.index("tsta") + 2] = theirs[theirs.index("tsta") + 2]
        assert ours == theirs
        if carrier.spelling == "binary":
            assert data.startswith(ours.to_bytes())


def test_help():
    answer = answers(FakeBoard())
    reply = answer("help all")
    assert reply[:3] == ["many", "[help] [all]", "[help] [more]"]
    assert len(reply) == len(grammar.usage()) + 2 and reply[-1] == "ok"
    details = answer("[help] [more]")
    assert details[1] == ["help", "all"] and details[2] == "   these lines"
    assert len(details) == 2 * len(grammar.usage()) + 2
    # Element 1 decides, even then.
    assert answer("help pid") == ["fail"]


def test_what_is_missing_fails():
    answer = answers(Bare())
    for interface in (*INTERFACES.values(), PID):
        for verb, rows in (("get", interface.get), ("set", interface.set)):
            for word, (form, _) in lookup(rows).items():
                if (verb, word) in (("get", "enc"), ("get", "encs"), ("get", "name")):
                    continue
                if (verb, word) == ("get", "type"):
                    continue  # joints revolve unless somebody says otherwise
                kind = "pos " if interface is PID else ""
                arguments = {
                    Form.ONE: "0 1 2",
                    Form.ALL: "(1 2)",
                    Form.SOME: "1 (0) (1)",
                }[form]
                request = f"{verb} {interface.word} {word} {kind}{arguments}"
                assert (request, answer(request)) == (request, ["fail"])
    for request in ("get ivar lvar", "get reca isca", "set reca cals", "calj 0 1 2 3 4", "park 1",
                    "cald 0", "cal x", "get mnum", "get mtnm", "set reca quca"):  # fmt: skip
        assert (request, answer(request)) == (request, ["fail"])
    assert answer("get type 0")[2] == 1987212385
    assert answer("get encs")[2] == [1.5, -2.0]


def test_questions_without_an_interface_are_not_counted():
    ask = texts(Bare())
    for request in ("get torq trqs", "get icmd cmds", "get intm mods", "get iimp ipr 0"):
        assert ask(request) == "[fail]"
    assert ask("get axes") == "[is] axes 2 [tsta] 0 t [ok]"


def test_parking_always_succeeds():
    class Stuck(Bare):
        def park(self, joints):
            raise RuntimeError("stuck")

    assert answers(Stuck())("park 0") == ["ok"]


def test_a_device_that_raises_fails_and_lives(caplog):
    class Broken(FakeBoard):
        def encoders(self):
            raise ValueError("broken wire")

        def position_move(self, joints, positions):
            raise ZeroDivisionError

    answer = answers(Broken())
    assert answer("get encs") == ["fail"] == answer("set pos 0 1")
    assert "broken wire" in caplog.text and "Traceback" not in caplog.text
    assert answer("get axes")[2] == 3


BAD = [
    "set pos", "set pos 0", "set pos 0 x", "set pos x 0", "set pos -1 0", "set pos 3 0",
    "set pos 1.5 0", "set pos (0) 0", "set pos 0 (1)", "set pos 0 nan", "set pos 0 inf",
    'set pos 0 "1"', "set pos 0 [one]", "set poss", "set poss 1 2 3", "set poss (1 2 x)",
    "set poss (1 2 nan)", "set poss (1 2 3 4)", "set poss ()", "set posg", "set posg 2 (0 1)",
    "set posg 2 (0 1) (1)", "set posg 1 (0 1) (1 2)", "set posg 2 (0 3) (1 2)",
    "set posg 0 () ()", "set posg -1 () ()", "set posg x (0) (1)", "set posg 2 (0 1) (1 nan)",
    "set icmd cmod 0", "set icmd cmod 0 5", "set icmd cmod 9 pos", "set icmd cmds (1 2 3)",
    "set icmd cmog 2 (0 1) (pos)", "set intm mode 0 7", "set intm mods comp comp comp",
    "set sto", "set sto 9", "set stog 2 (0 9)", "set enc 0", "set ere 7", "set llim 0 1",
    "set llim 0 1 x", "set aen", "set aen 4", "calj x 1 2 3 4", "calj 0 x 2 3 4", "calj 9 1 2 3 4",
    "cljp 0 1 2 3 4", "set reca cal", "set reca cal 9", "set torq ref 0 nan", "set rel 0 inf",
    "set vmos (1 2)", "set torq refs (a b c)", "set relg 1 (7) (1)",
]  # fmt: skip


@pytest.mark.parametrize("request_", BAD)
def test_bad_input_leaves_the_device_alone(request_):
    device = FakeBoard()
    before = {name: repr(value) for name, value in vars(device).items() if name != "pids"}
    assert answers(device)(request_) == ["fail"]
    assert {name: repr(value) for name, value in vars(device).items() if name != "pids"} == before


WORDS = sorted(
    {word for i in (*INTERFACES.values(), PID) for rows in (i.get, i.set) for word in lookup(rows)}
    | {*INTERFACES, "pid", "ivar", "reca", "prot", "mvar", "lvar", "isca", "get", "set", "help"}
    | {"calj", "cljp", "cald", "cal", "park", "more", "gain", "vel", "trq", "axes", "mnum"}
)
elements = st.recursive(
    st.one_of(
        st.sampled_from(WORDS),
        st.sampled_from(WORDS).map(Vocab),
        st.integers(-5, 5),
        st.integers(),
        st.floats(),
        st.booleans(),
        st.text(max_size=6),
        st.binary(max_size=4),
        st.none(),
    ),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=6,
)
requests = st.builds(
    lambda head, tail: [*head, *tail],
    st.tuples(st.sampled_from(["get", "set", "help", "calj", "cal"]), st.sampled_from(WORDS)),
    st.lists(elements, max_size=6),
)


@settings(max_examples=400)
@given(st.one_of(requests, st.lists(elements, max_size=6)))
def test_whatever_is_asked_there_is_a_reply(request_):
    device = FakeBoard()
    reply = Responder(Board(device, "/head")).answer(request_)
    assert reply[-1] in ("ok", "fail", "nak")
    if reply[0] in ("fail", "nak"):
        assert len(reply) == 1
        assert device.done == []
    assert (
        all(isinstance(value, float) and abs(value) < float("inf") for value in device.where)
        and len(device.where) == 3
    )


@settings(max_examples=300)
@given(st.data())
def test_requests_with_one_thing_changed(data):
    """What people and broken programs send: nearly right."""
    request = Bottle.from_text(data.draw(st.sampled_from([text for text, _ in SPEC if text])))
    index = data.draw(st.integers(0, len(request) - 1))
    match data.draw(st.sampled_from(["drop", "replace", "insert", "wrap"])):
        case "drop":
            del request[index]
        case "replace":
            request[index] = data.draw(elements)
        case "insert":
            request.insert(index, data.draw(elements))
        case "wrap":
            request[index] = [request[index]]
    device = FakeBoard(4)
    reply = Responder(Board(device, "/head")).answer(request)
    assert reply[-1] in ("ok", "fail", "nak")
    if reply[0] in ("fail", "nak"):
        assert device.done == []
