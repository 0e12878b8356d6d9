"""Lua scripts: YARP's classes as they know them, callbacks, errors, and the limits they meet."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.errors import LocalProtocolError
from yarpy.monitors import extra
from yarpy.monitors.event import Events
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.script import ScriptError
from yarpy.wire.message import DATA, Message, Packet

pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
from yarpy.monitors.script import lua
from yarpy.monitors.script.lua import LuaScript

PATH = Path("/nowhere/gate.lua")


def load(text: str, control: Control | None = None, **limits: int) -> LuaScript:
    control = control or Control(events=Events())
    return LuaScript(PATH, text.encode("utf-8", "surrogateescape"), control, **limits)


def message(*values: object) -> Message:
    return Message(DATA, Bottle(values).to_bytes(), "3 0.5")


def said(body: str, given: Message | None = None) -> str:
    """What a callback gives `say`, with `thing` at hand."""
    text = f"""
require("yarp")
local said = ""
local function say(...)
    for i = 1, select("#", ...) do said = said .. tostring((select(i, ...))) .. " " end
end
PortMonitor.accept = function(thing)
    {body}
    return true
end
PortMonitor.getparam = function()
    local p = yarp.Property()
    p:put("said", said)
    return p
end
"""
    script = load(text)
    assert script.accept(given or message("hi"))
    found = script.parameters()["said"]
    assert isinstance(found, str)
    return found.rstrip(" ")


def updated(body: str, given: Message) -> object:
    """What an update makes of a message; None if it leaves it as it is."""
    made = load(f'require("yarp")\nPortMonitor.update = function(thing)\n{body}\nend').update(given)
    return made.value if isinstance(made, Message) else made


# -- YARP's classes -------------------------------------------------------------------------------

EVERY = message(
    1, -2.5, "two words", Vocab("set"), True, [1, ["in"]], b"\0\1", Int8(-3), Int16(300),
    Int64(5), Float32(0.5), {"key": 7}, 2**40,
)  # fmt: skip


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("local b = thing:asBottle() say(b:size(), b:isNull())", "13 false"),
        ("say(thing:asBottle():get(0):asInt32() + 1)", "2"),
        ("say(thing:asBottle():get(0):asInt(), thing:asBottle():get(0):asFloat64())", "1 1.0"),
        ("say(thing:asBottle():get(1):asDouble(), thing:asBottle():get(1):asInt32())", "-2.5 -2"),
        ("say(thing:asBottle():get(2):asString(), thing:asBottle():get(2):asInt32())",
         "two words 0"),
        ("local v = thing:asBottle():get(3) say(v:isVocab32(), v:asString(), v:asVocab())",
         "true set 7628147"),
        ("local v = thing:asBottle():get(4) say(v:isBool(), v:asBool(), v:isString())",
         "true true false"),
        ("local l = thing:asBottle():get(5):asList() say(l:size(), l:get(1):asList():toString())",
         "2 in"),
        ("say(#thing:asBottle():get(6):asBlob(), thing:asBottle():get(6):isBlob())", "2 true"),
        ("local b = thing:asBottle() for i = 7, 9 do say(b:get(i):asInt64()) end", "-3 300 5"),
        ("local b = thing:asBottle() say(b:get(7):isInt8(), b:get(8):isInt16(), b:get(9):isInt())",
         "true true false"),
        ("say(thing:asBottle():get(10):asFloat32(), thing:asBottle():get(10):isFloat64())",
         "0.5 false"),
        ("say(thing:asBottle():get(11):asDict():find('key'):asInt32())", "7"),
        ("say(thing:asBottle():get(12):asInt64())", "1099511627776"),
        ("local v = thing:asBottle():get(13) say(v:isNull(), v:asInt32(), v:asBool())",
         "true 0 false"),
        ("say(thing:asBottle():get(5):asString(), thing:asBottle():get(0):asList() == nil)",
         " true"),
        ("say(thing:asValue():isList(), thing:asBottle():get(2):toString())", "true two words"),
    ],
)  # fmt: skip
def test_reading_a_bottle(body: str, expected: str) -> None:
    assert said(body, EVERY).split() == expected.split()


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("b:addInt32(1) b:addInt(2)", "1 2"),
        ("b:addInt8(1) b:addInt16(2) b:addInt64(3)", "1 2 3"),
        ("b:addFloat64(1) b:addDouble(2.5) b:addFloat32(0.5)", "1.0 2.5 0.5"),
        ("b:addInt32(3.0) b:addString('a b') b:addString('c')", '3 "a b" c'),
        ("b:addVocab32('set') b:addVocab(7628147) b:addBool(true)", "[set] [set] true"),
        ("b:addList():addInt(1) b:addList()", "(1) ()"),
        ("b:add(yarp.Value(1)) b:add(yarp.Value('x')) b:add(2.5)", "1 x 2.5"),
        ("b:addInt(1) b:addInt(2) b:pop() b:pop() b:pop()", ""),
        ("b:fromString('a (b 1) [c]') b:append(yarp.Bottle('d e'))", "a (b 1) [c] d e"),
        ("b:copy(yarp.Bottle('a (b 1) c'):tail())", "(b 1) c"),
        ("b:copy(yarp.Bottle():tail())", ""),
        ("b:copy(yarp.Bottle('a b c d'), 1, 2)", "b c"),
        ("b:copy(yarp.Bottle('a b c d'), 3, 9)", "d"),
        ("b:copy(yarp.Bottle('a b'), 7)", ""),
        ("b:addInt(1) b:clear() b:addInt(2)", "2"),
        ("local c = yarp.Bottle('x (y)') b:copy(c) c:get(1):asList():addInt(9)", "x (y)"),
        ("b:add(b) b:add(b)", "() (())"),
        ("b:addString(5) b:addInt('7')", '"5" 7'),
    ],
)
def test_writing_a_bottle(body: str, expected: str) -> None:
    assert said(f"local b = yarp.Bottle() {body} say(b:toString())") == expected
    made = updated(f"local b = thing:asBottle() b:clear() {body} return thing", message("old"))
    assert made == Bottle.from_text(expected)


def test_finding_in_a_bottle() -> None:
    given = message("name", "ball", ["colour", "red", 5], ["size"], "size", 3)
    body = """
local b = thing:asBottle()
say(b:find("name"):asString(), b:find("colour"):asString(), b:find("none"):isNull())
say(b:findGroup("colour"):size(), b:findGroup("name"):isNull(), b:findGroup("colour"):isNull())
say(b:check("colour"), b:check("none"), b:check("name"))"""
    assert said(body, given) == "ball red true 3 true false true false true"


def test_property() -> None:
    body = """
local p = yarp.Property()
say(p:check("a"))
p:put("a", 1) p:put("b", "x y") p:put("a", 2.5) p:put("c", yarp.Bottle("1 2"))
say(p:find("a"):asFloat64(), p:check("b"), p:find("none"):asInt32(), p:toString())
p:unput("b")
p:fromString("(d 4) (c 5)", true)
say(p:findGroup("d"):size(), p:find("c"):asInt32(), p:check("b"), p:check("a"))
p:fromString("(e 1)")
say(p:check("a"), p:find("e"):asInt32())
p:addGroup("g"):put("h", 1)
say(p:findGroup("g"):toString(), p:findGroup("none"):isNull())
p:clear()
say(p:toString() == "")"""
    assert said(body) == (
        'false 2.5 true 0 (b "x y") (a 2.5) (c (1 2)) 2 5 false true false 1 g (h 1) true true'
    )


def test_value_vector_matrix_and_the_rest_of_the_module() -> None:
    body = """
say(yarp.Value():isNull(), yarp.Value(true):asBool(), yarp.Value(2):isInt32())
say(tostring(yarp.Value(3)))
local v = yarp.Vector(2)
v:push_back(3) v:set(0, 1) v[1] = 2
say(v:size(), v:get(0), v[1], v[2], v:toString())
v:resize(4, 9) v:resize(3) say(v:size(), yarp.Vector(v):length())
local m = yarp.Matrix(2, 3)
m:eye() m:set(1, 2, 5)
say(m:rows(), m:cols(), m:get(1, 2), m:getRow(1):toString())
say(yarp.Vocab32_decode(yarp.Vocab32_encode("set")), yarp.Time_now() > 1e9, yarp.now() > 1e9)
say(loadstring("return 1")(), string.format("%d", 3), unpack({ 4, 5 }))"""
    assert said(body) == (
        "true true true 3 3 1.0 2.0 3.0 1.0 2.0 3.0 3 3 2 3 5.0 0.0 1.0 5.0 set true true 1 3 4 5"
    )


def test_vector_message() -> None:
    vector = Message(DATA, b"".join(Vector([1, 2.5]).to_wire()))
    made = updated("thing:asVector():push_back(3) return thing", vector)
    assert isinstance(made, Vector)
    assert made == [1.0, 2.5, 3.0]
    ints = Message(DATA, b"".join(Vector([1, 2], "int32").to_wire()))
    assert updated("local v = thing:asVector() v:set(0, 9) return thing", ints) == [9.0, 2.0]
    assert updated("return thing:asVector() == nil and thing or nil", message("x")) is None


def test_matrix_message() -> None:
    matrix = Message(DATA, b"".join(Matrix([[1, 2, 3], [4, 5, 6]]).to_wire()))
    script = load(
        "PortMonitor.update = function(thing)\n"
        "local m = thing:asMatrix() m:set(1, 2, m:get(0, 1)) return thing end"
    )
    made = script.update(matrix)
    assert isinstance(made, Message)
    assert made.as_(Matrix) == Matrix([[1, 2, 3], [4, 5, 2]])


def picture(code: str, shape: tuple[int, ...], dtype: str) -> Message:
    array = np.arange(int(np.prod(shape))).reshape(shape).astype(dtype)
    return Message(DATA, b"".join(Image(array, code).to_wire()))


def test_image_message() -> None:
    given = picture("rgb", (5, 7, 3), "u1")
    body = """
local i = thing:asImage()
assert(i:width() == 7 and i:height() == 5 and i:getPixelSize() == 3)
local p = i:pixel(2, 1)
assert(p.r == (7 + 2) * 3 and p.b == p.r + 2 and p.a == nil)
p.r = 255
p.g = p.r - 1
i:setPixel(6, 4, { r = 1, g = 2, b = 3 })
assert(p.r == 255 and i:pixel(2, 1).g == 254)
return thing"""
    made = updated(body, given)
    expected = given.as_(Image).array.copy()
    expected[1, 2, :2] = 255, 254
    expected[4, 6] = 1, 2, 3
    assert made == Image(expected)


@pytest.mark.parametrize(
    ("code", "dtype", "value"), [("mono", "u1", 200), ("mo16", "u2", 60000), ("dec", "f4", 0.25),
                                 ("int", "i4", -5), ("sign", "i1", -5)],
)  # fmt: skip
def test_grey_images(code: str, dtype: str, value: float) -> None:
    given = picture(code, (3, 5000), dtype)
    made = updated(
        f"local i = thing:asImage() i:setPixel(4500, 2, {value})\n"
        f"assert(i:getPixel(4500, 2) == {value} and i:pixel(1, 0) == 1) return thing",
        given,
    )
    expected = given.as_(Image).array.copy()
    expected[2, 4500] = value
    assert made == Image(expected, code)


def test_images_of_other_kinds_and_new_ones() -> None:
    given = picture("mono", (2, 2), "u1")
    made = updated("local i = thing:asImageOfPixelRgb() i:pixel(0, 0).r = 9 return thing", given)
    assert isinstance(made, Image)
    assert (made.code, made.array[0, 0].tolist(), made.array[1, 1].tolist()) == (
        "rgb", [9, 0, 0], [3, 3, 3],
    )  # fmt: skip
    body = """
local i = yarp.ImageMono()
i:resize(3, 2) i:setPixel(2, 1, 7)
local copy = yarp.ImageRgb()
copy:copy(i)
local t = yarp.Things()
t:setPortWriter(copy)
return t"""
    assert updated(body, given) == Image(np.array([[0, 0, 0], [0, 0, 7]], "u1"))
    assert updated("assert(thing:asImage() == nil)", message("x")) is None


@pytest.mark.parametrize(
    "body",
    [
        "thing:asImage():pixel(2, 0)", "thing:asImage():pixel(-1, 0)",
        "thing:asImage():setPixel(0, 0, 256)", "thing:asImage():setPixel(0, 0, 'x')",
        "thing:asImageOfPixelRgb():pixel(0, 0).nosuch = 1", "thing:asImage():resize(1e9, 1)",
        "yarp.Vector(2):get(2)", "yarp.Vector(2):set(0, 'x')", "yarp.Matrix(2, 2):get(0, 2)",
        "yarp.Bottle():addInt32(2 ^ 31)", "yarp.Bottle():addInt8(128)", "yarp.Bottle():addInt(0/0)",
        "yarp.Bottle():add(print)", "yarp.Bottle():addInt({})", "yarp.Property():put('a', {})",
    ],
)  # fmt: skip
def test_misuse_is_an_error_at_the_line_of_the_script(body: str) -> None:
    script = load(f'require("yarp")\nPortMonitor.accept = function(thing)\n  {body}\nend')
    with pytest.raises(ScriptError, match=f"^{re.escape(str(PATH))}:3: "):
        script.accept(picture("mono", (2, 2), "u1"))


# -- callbacks ------------------------------------------------------------------------------------

WHOLE = """
require("yarp")
local level, trigs = 1, 0
PortMonitor.create = function(options)
    side = options:find("sender_side"):asInt32()
    return options:find("source"):asString() == "/a"
end
PortMonitor.accept = function(thing)
    return thing:asBottle():get(0):asString() ~= "drop"
end
PortMonitor.update = function(thing)
    local b = thing:asBottle()
    b:addInt32(level)
    return thing
end
PortMonitor.update_reply = function(thing)
    thing:asBottle():addString("replied")
end
PortMonitor.trig = function() trigs = trigs + 1 end
PortMonitor.setparam = function(property)
    if property:check("level") then level = property:find("level"):asInt32() end
end
PortMonitor.getparam = function()
    local p = yarp.Property()
    p:put("level", level) p:put("trigs", trigs) p:put("side", side)
    return p
end
PortMonitor.destroy = function() print("destroyed", level) end
"""


def test_every_callback(capsys: pytest.CaptureFixture[str]) -> None:
    script = load(WHOLE)
    assert script.create(Property(source="/a", sender_side=1))
    assert not load(WHOLE).create(Property(source="/b"))
    assert [script.accept(message("hi")), script.accept(message("drop"))] == [True, False]
    script.trigger()
    script.configure(Property(level=5))
    assert script.parameters() == {"level": 5, "side": 1, "trigs": 1}
    given = message("hi")
    assert script.accept(given)
    made = script.update(given)
    assert isinstance(made, Message)
    assert (made.value, made.envelope) == (["hi", 5], "3 0.5")
    reply = script.update_reply(message("yes"))
    assert isinstance(reply, Message)
    assert reply.value == ["yes", "replied"]
    script.close()
    script.close()
    assert capsys.readouterr().out == "destroyed\t5\n"


def test_script_without_callbacks_does_nothing() -> None:
    script = load("x = 1")
    assert script.create(Property())
    assert script.accept(message("hi"))
    assert script.update(message("hi")) is None
    assert script.update_reply(message("hi")) is None
    script.trigger()
    script.configure(Property(a=1))
    assert script.parameters() == {}
    script.close()


def test_message_that_is_not_touched_goes_on_as_it_came() -> None:
    looks = load("PortMonitor.update = function(t) return t:asBottle():size() and t end")
    assert looks.update(message("hi")) is None
    nothing = load("PortMonitor.update = function(t) end")
    assert nothing.update(message("hi")) is None


def test_what_accept_changed_counts() -> None:
    script = load("PortMonitor.accept = function(t) t:asBottle():addInt(1) return true end")
    given = message("hi")
    assert script.accept(given)
    made = script.update(given)
    assert isinstance(made, Message)
    assert made.value == ["hi", 1]
    other = message("ho")  # that of another connection came between
    assert script.accept(given)
    assert script.update(other) is None


def test_thing_is_the_same_in_accept_and_update() -> None:
    script = load("""
PortMonitor.accept = function(t) b = t:asBottle() return true end
PortMonitor.update = function(t) b:addInt(t:asBottle():size()) return t end""")
    for _ in range(2):
        given = message("hi", "ho")
        assert script.accept(given)
        made = script.update(given)
        assert isinstance(made, Message)
        assert made.value == ["hi", "ho", 2]


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        ("yarp.Bottle('a 1')", ["a", 1]),
        ("yarp.Vector(2, 1)", [1.0, 1.0]),
        ("yarp.Value(7)", [7]),
        ("yarp.Property('(a 1)')", [["a", 1]]),
    ],
)
def test_update_may_give_another_object(result: str, expected: object) -> None:
    assert updated(f"return {result}", message("x")) == expected
    body = f"local t = yarp.Things() t:setPortWriter({result}) return t"
    assert updated(body, message("x")) == expected
    assert updated(f"thing:setPortWriter({result})", message("x")) == expected


@pytest.mark.parametrize("result", ["1", "'text'", "{}", "print"])
def test_update_that_gives_something_else_fails(result: str) -> None:
    with pytest.raises(ScriptError, match="an update gives the thing"):
        updated(f"return {result}", message("x"))


def test_text_and_objects_are_read_alike() -> None:
    body = 'return thing:asBottle():get(1):asString() == "b"'
    script = load(f"PortMonitor.accept = function(thing) {body} end")
    assert script.accept(Message(DATA, "a b", spelling="text"))
    assert script.accept(Message.of(Packet(("a", "b"))))
    assert not script.accept(Message.of(Packet(["a"])))
    nil = load("PortMonitor.accept = function(t) return t:asBottle() == nil end")
    assert nil.accept(Message(DATA, b"\1\2"))
    assert nil.accept(Message.of(Packet(object())))


def test_events_and_constraint() -> None:
    events = Events()
    control = Control(events=events)
    script = load(
        """
PortMonitor.accept = function()
    PortMonitor.setEvent("e_ball", 10)
    PortMonitor.setConstraint("not e_ball")
    return PortMonitor.getConstraint() == "not e_ball"
end
PortMonitor.trig = function() PortMonitor.unsetEvent("e_ball") end""",
        control,
    )
    assert script.accept(message())
    assert (events.has("e_ball"), control.allows()) == (True, False)
    script.trigger()
    assert control.allows()


def test_modules_beside_the_script(tmp_path: Path) -> None:
    (tmp_path / "helper.lua").write_text("return { word = 'helped' }")
    text = (
        "local h = require('helper')\nPortMonitor.accept = function() return h.word == 'helped' end"
    )
    assert LuaScript(tmp_path / "a.lua", text.encode(), Control()).accept(message())


REACHES = [
    "io.open('/etc/hostname')", "os.execute('true')", "os.getenv('HOME')", "os.remove('x')",
    "os.tmpname()", "require('io').lines('/etc/hostname')", "require('os').rename('a', 'b')",
    "dofile('/etc/hostname')", "loadfile('/etc/hostname')()", "require('../helper')",
    "require('/etc/hostname')", "require('a.b')", "package.searchpath('a', '?')",
    "package.path.x = 1", "require('package').searchers[2]('helper')",
    "string.find = function() return 1 end require('../helper')",
    "string.find = function() return 1 end string.gsub = string.find require('x/../../helper')",
]  # fmt: skip


@pytest.mark.parametrize("body", REACHES)
def test_disk_and_programs_are_out_of_reach(tmp_path: Path, body: str) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "helper.lua").write_text("return { word = 'helped' }")
    text = f"PortMonitor.accept = function() {body} return true end"
    script = LuaScript(inner / "a.lua", text.encode(), Control())
    with pytest.raises(ScriptError):
        script.accept(message())


def test_owner_may_let_scripts_have_all_of_lua(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("seen")
    file = (tmp_path / "x").as_posix()
    text = f"PortMonitor.accept = function() return io.open('{file}'):read() == 'seen' end"
    assert LuaScript(tmp_path / "a.lua", text.encode(), Control(), system=True).accept(message())
    text = "PortMonitor.accept = function() return os.time() > 0 and os.clock() >= 0 end"
    assert LuaScript(tmp_path / "a.lua", text.encode(), Control()).accept(message())


# -- errors and limits ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("PortMonitor.accept = function(", f"{PATH}:1: "),
        ("x = 1\nnosuch()", f"{PATH}:2: attempt to call a nil value"),
        ("PortMonitor = nil", "PortMonitor must stay a table"),
        ("require('nosuchmodule')", "module 'nosuchmodule' not found"),
        ("\x1bLua", "attempt to load a binary chunk"),
        ("while true do end", f"{PATH}:1: it runs for more than"),
    ],
)
def test_file_that_cannot_run_says_why(text: str, expected: str) -> None:
    with pytest.raises(ScriptError) as caught:
        load(text, limit=10_000)
    assert expected in str(caught.value)
    assert str(PATH) in str(caught.value)


ENDLESS = [
    "while true do end",
    "local function f() return f() end f()",
    "while true do pcall(function() while true do end end) end",
    "pcall(pcall, function() while true do end end) while true do end",
    "xpcall(function() while true do end end, function() while true do end end)",
    "coroutine.wrap(function() while true do end end)()",
    "while true do coroutine.wrap(function() pcall(function() while true do end end) end)() end",
    "while true do coroutine.wrap(function() end)() end",
    "table.sort({ 3, 2, 1 }, function() while true do end end)",
    "string.gsub('aaa', 'a', function() while true do end end)",
    "for i = 1, 1e9 do yarp.Bottle():addInt(1) end",
    "setmetatable({}, { __index = function() while true do end end }).x = nil "
    "local x = setmetatable({}, { __index = function() while true do end end }).x",
    "local c <close> = setmetatable({}, { __close = function() while true do end end })",
    "tostring(setmetatable({}, { __tostring = function() while true do end end }))",
]
GROWING = [
    "local t = {} while true do t[#t + 1] = 'a' .. #t end",
    "local t = {} for i = 1, 1e9 do t[i] = i end",
    "local s = 'x' while true do s = s .. s end",
    "return string.rep('x', 1e9)",
    "local b = yarp.Bottle() while true do b:addString('xxxxxxxxxxxxxxxx') end",
    "collectgarbage('stop') while true do local t = { {}, {} } end",
    "local v = yarp.Vector() v:resize(1e9)",
    "yarp.ImageRgb():resize(1e5, 1e5)",
]
FORBIDDEN = [
    "os.exit(3)",
    "require('os').exit(3)",
    "debug.sethook()",
    "require('debug').sethook()",
    "python.eval('1')",
    "require('python').eval('1')",
    "setmetatable({}, { __gc = function() while true do end end })",
    "assert(load(string.dump(function() end)))()",
    "package.loadlib('libc.so.6', '*')()",
    "coroutine.yield(1)",
    "error({})",
    "error(setmetatable({}, { __tostring = function() while true do end end }))",
    "error()",
    "local t = setmetatable({}, { __index = function(t, k) return t[k] end }) return t.x",
    "local function f() f() end f()",
]


@pytest.mark.parametrize("body", [*ENDLESS, *GROWING, *FORBIDDEN])
def test_script_is_stopped_and_goes_on_with_the_next_message(body: str) -> None:
    fine = "if t:asBottle():size() > 1 then return true end"
    text = f"PortMonitor.accept = function(t) {fine} {body} end"
    script = load(text, limit=2_000_000, memory=8 << 20)
    for _ in range(2):
        with pytest.raises(ScriptError, match=r"nowhere.gate") as caught:
            script.accept(message("hi"))
        assert len(str(caught.value)) > len(str(PATH)) + 5
        assert script.accept(message("hi", "ho"))
    if body in ENDLESS:
        assert "it runs for more than 2000000 instructions" in str(caught.value)


def test_memory_that_ends_outside_of_a_script_is_named() -> None:
    def full() -> None:
        raise MemoryError  # as lupa does, without a word

    with pytest.raises(ScriptError, match=r"gate\.lua: not enough memory"):
        load("PortMonitor.accept = function() return true end")._done(full)


HUGE = "setmetatable({}, { __len = function() return 1 << 60 end, __index = type })"
IN_THE_LIBRARY = [
    "string.find(string.rep('a', 5000), '.-.-.-.-b')",
    "string.match(('a'):rep(3000), '(a*)a-a+a-b')",
    "for word in ('a'):rep(3000):gmatch('a-a-a-a-b') do end",
    "string.gsub(('a'):rep(3000), 'a-a-a-a-b', '')",
    "string.find(('a'):rep(30), ('a?'):rep(30) .. ('a'):rep(30))",
    "string.find(('a'):rep(1 << 20), ('a'):rep(1 << 19) .. 'b', 1, true)",
    "string.rep('', 1e15)",
    "string.rep('', '1000000000000000')",
    "table.move({}, 1, 1e15, 2)",
    f"table.insert({HUGE}, 1, 2)",
    f"table.remove({HUGE}, 1)",
    f"table.concat({HUGE})",
    f"table.sort({HUGE})",
    "getmetatable('').__index = function() while true do end end while true do end",
    "string.sub = function() while true do end end while true do end",
    "local s = ('x'):rep(2 << 20) for i = 1, 1e9 do local y = s .. i end",
    "local s = ('x = 1 '):rep(1 << 18) for i = 1, 1e9 do load(s) end",
    "local s = ('1 '):rep(1 << 16) for i = 1, 1e9 do yarp.Bottle(s) end",
]


@pytest.mark.parametrize("body", IN_THE_LIBRARY)
def test_no_function_of_the_library_takes_longer_than_a_script_may(
    body: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing counts instructions there, and nobody could end it."""
    monkeypatch.setattr(lua, "SCRIPT_SECONDS", 0.1)
    fine = "if t:asBottle():size() > 1 then return true end"
    script = load(f"PortMonitor.accept = function(t) {fine} {body} end", memory=16 << 20)
    for _ in range(2):
        with pytest.raises(ScriptError, match=r"nowhere.gate"):
            script.accept(message("hi"))
        assert script.accept(message("hi", "ho"))


PATTERNS = [
    *(
        "a",
        "a*",
        "a-b",
        "(a+)(b?)",
        "^a",
        "a$",
        "^(a*)$",
        "()a()",
        "%a+",
        "[ab]+",
        "[^a]",
        "[a-c]*",
    ),
    *("(a)(b)%1", "%b()", "%f[%w]%w+", ".", "%.", "[]]", "[%]a]", "[a-]", "(.)%1", "(a(b)c)", ""),
    *("a**", "^", "$", "a$b", "%d%s", "(a*(.)%w(%s*))", "[%a_][%w_]*", "^%s*(.-)%s*$", "[^%s]+"),
]
WRONG = ["(", "%", "[a", "a)", "%1", "%f", "%b(", "(()", "[%", "(a%1)"]
SUBJECTS = [
    "",
    "a",
    "aab abc",
    "  key = value ",
    "(a(b)c) (d",
    "aa]b-c",
    "a_1 b2",
    "\0a\xffb",
    "][",
]


def test_patterns_match_as_those_of_lua() -> None:
    """What is done step by step where the original might take for ever."""
    lua_state = lua.lupa().LuaRuntime(encoding=None, unpack_returned_tuples=True)
    source = lua._source("pattern")
    load_it = lua_state.eval(b"function(s) return assert(load(s, '=pattern', 't')) end")
    originals = {
        name: lua_state.eval(f"string.{name}".encode())
        for name in ("find", "match", "gmatch", "gsub")
    }
    nothing = lua_state.eval(b"function() end")  # ... is quick
    load_it(source)(nothing, lua_state.eval(b"function(why) error(why, 0) end"), nothing)
    ours = {name: lua_state.eval(f"string.{name}".encode()) for name in originals}
    collect = lua_state.eval(
        b"function(gmatch, s, p) local found = {} "
        b"for a, b in gmatch(s, p) do found[#found + 1] = tostring(a) .. '/' .. tostring(b) end "
        b"return table.concat(found, ' ') end"
    )
    protected = lua_state.eval(b"pcall")
    upper = lua_state.eval(b"function(a, b) return a ~= 'b' and tostring(a) .. tostring(b) end")
    table = lua_state.eval(b"{ a = 'x', b = 7 }")
    for pattern in (*PATTERNS, *WRONG):
        for text in SUBJECTS:
            s, p = text.encode("latin-1"), pattern.encode()
            calls = [
                ("find", (s, p)),
                ("match", (s, p)),
                ("find", (s, p, 2)),
                ("match", (s, p, -2)),
            ]
            calls += [("gsub", (s, p, by)) for by in (b"<%0>", b"<%1%%>", upper, table, b"", b"%")]
            calls += [("gsub", (s, p, b"%0%0", 1))]
            for name, arguments in calls:
                expected = protected(originals[name], *arguments)
                found = protected(ours[name], *arguments)
                assert isinstance(found, tuple) == isinstance(expected, tuple)
                if expected is True or expected[0] is True:
                    assert found == expected or pattern in WRONG, (name, arguments)
                else:
                    assert found[0] is False and found[1] in expected[1], (name, arguments)
            if pattern in PATTERNS:
                expected = collect(originals["gmatch"], s, p)
                assert collect(ours["gmatch"], s, p) == expected, (s, p)


def test_other_threads_run_while_a_script_does() -> None:
    import threading

    script = load("PortMonitor.accept = function() for i = 1, 1e7 do end return true end")
    done: list[bool] = []
    thread = threading.Thread(target=lambda: done.append(script.accept(message())))
    thread.start()
    count = 0
    while thread.is_alive():
        count += 1
        time.sleep(0.0001)
    thread.join()
    assert done == [True]
    assert count > 5


def test_long_runs_neither_leak_nor_confuse_objects() -> None:
    """Garbage is collected on the way: everything must still be what it is."""
    script = load(WHOLE, memory=4 << 20)
    script.create(Property(source="/a"))
    for number in range(20_000):
        given = message("hi", number, [number], "x" * 50)
        assert script.accept(given)
        made = script.update(given)
        assert isinstance(made, Message)
        if number % 1000 == 0:
            assert made.value == ["hi", number, [number], "x" * 50, 1]


def test_without_the_library_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ModuleNotFoundError(f"No module named {name!r}")

    monkeypatch.setattr(extra, "import_module", missing)
    with pytest.raises(LocalProtocolError, match=r'pip install "yarpy\[lua\]"'):
        lua.lupa()


# -- whatever comes -------------------------------------------------------------------------------

SIMPLE = (
    st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False)
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=10)
    | st.booleans()
    | st.binary(max_size=10)
    | st.builds(Vocab, st.text("abcd", min_size=1, max_size=4))
)
VALUES = st.recursive(SIMPLE, lambda inner: st.lists(inner, max_size=4).map(Bottle), max_leaves=10)


@pytest.fixture(scope="module")
def rewrite() -> Callable[[Message], object]:
    text = """
PortMonitor.update = function(t)
    local fresh = yarp.Bottle()
    fresh:copy(t:asBottle())
    return fresh
end"""
    return load(text).update


@given(values=st.lists(VALUES, max_size=6))
def test_what_lua_reads_and_writes_is_the_same(
    rewrite: Callable[[Message], object], values: list[object]
) -> None:
    given_ = message(*values)
    made = rewrite(given_)
    assert isinstance(made, Message)
    assert bytes(made.payload) == bytes(given_.payload)


@pytest.fixture(scope="module")
def casts() -> LuaScript:
    names = ("Bottle", "Property", "Value", "Vector", "Matrix", "Image", "ImageOfPixelRgb")
    calls = " ".join(f"t:as{name}()" for name in names)
    return load(f"PortMonitor.accept = function(t) {calls} return true end")


@given(data=st.binary(max_size=60))
def test_any_bytes_are_cast_or_are_nil(casts: LuaScript, data: bytes) -> None:
    assert casts.accept(Message(DATA, data))


@given(data=st.data())
def test_changed_messages_are_cast_or_are_nil(casts: LuaScript, data: st.DataObject) -> None:
    matrix = Message(DATA, b"".join(Matrix([[1, 2]]).to_wire()))
    original = data.draw(st.sampled_from([EVERY, picture("rgb", (2, 3, 3), "u1"), matrix]))
    payload = bytearray(original.payload)
    for _ in range(data.draw(st.integers(1, 4))):
        payload[data.draw(st.integers(0, len(payload) - 1))] = data.draw(st.integers(0, 255))
    assert casts.accept(Message(DATA, bytes(payload)))
