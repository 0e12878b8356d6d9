"""Values between C++ and yarpy: Bottles of every kind, Vector, Matrix, Sound, Property, Stamp."""

import math

import numpy as np
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG

import yarpy
from yarpy import (
    Bottle,
    Float32,
    Int8,
    Int16,
    Int64,
    Matrix,
    Property,
    Sound,
    Stamp,
    Vector,
    Vocab,
)
from yarpy.data.yarp4 import to_yarp4

SIDE = """
port = yarp.Port()
assert port.open('/cpp')
def read(what):
    assert port.read(what)
    return what
def codes(bottle):
    return [bottle.get(i).getCode() for i in range(bottle.size())]
"""


# What C++ 3 calls the kinds, how to add one there, how to see one there, the value here.
ELEMENTS = [
    (32, "addInt8(-5)", "asInt8()", Int8(-5)),
    (64, "addInt16(-500)", "asInt16()", Int16(-500)),
    (1, "addInt32(-50000)", "asInt32()", -50000),
    (17, "addInt64(5)", "asInt64()", Int64(5)),
    (17, "addInt64(1 << 62)", "asInt64()", 1 << 62),
    (128, "addFloat32(2.5)", "asFloat32()", Float32(2.5)),
    (10, "addFloat64(0.1)", "asFloat64()", 0.1),
    (10, "addFloat64(float('inf'))", "asFloat64()", math.inf),
    (4, "addString('héllo wörld')", "asString()", "héllo wörld"),
    (4, "addString('')", "asString()", ""),
    (9, "addVocab32('abc')", "asVocab32()", Vocab("abc")),
]


#: What YARP 4 calls some of them.
CODES_OF_4 = {128: 10, 10: 20}


def spelled(cpp: CppYarp, payload: bytes) -> bytes:
    """These bytes as this C++ sends them."""
    return payload if cpp.version < (4, 0) else bytes(to_yarp4(payload))


def test_elements_from_cpp(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    """Each kind alone (a list of one), in threes (a specialised list) and all together."""
    for code, add, _, value in ELEMENTS:
        for count in (1, 3):
            side.begin(
                f"bottle = yarp.Bottle()\nfor _ in range({count}): bottle.{add}\nport.write(bottle)"
            )
            message = port.read(timeout=HANG)
            assert side.end()
            found = message.as_(Bottle)
            assert found == [value] * count
            assert all(type(item) is type(value) for item in found), (code, found)
            assert spelled(cpp, found.to_bytes()) == bytes(message.payload)
    adding = "; ".join(f"bottle.{add}" for _, add, _, _ in ELEMENTS)
    side.begin(f"bottle = yarp.Bottle(); {adding}\nport.write(bottle)")
    message = port.read(timeout=HANG)
    assert side.end()
    assert message.value == [value for *_, value in ELEMENTS]
    assert spelled(cpp, message.value.to_bytes()) == bytes(message.payload)


def test_elements_from_yarpy(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    other = {} if cpp.version < (4, 0) else CODES_OF_4
    for code, _, see, value in ELEMENTS:
        for count in (1, 3):
            side.begin(f"bottle = read(yarp.Bottle()); [codes(bottle), bottle.get(0).{see}]")
            port.write([value] * count)
            seen_codes, seen = side.end()
            assert seen_codes == [other.get(code, code)] * count
            assert seen == (value.code if isinstance(value, Vocab) else value)
    side.begin("codes(read(yarp.Bottle()))")
    port.write([value for *_, value in ELEMENTS])
    assert side.end() == [other.get(code, code) for code, *_ in ELEMENTS]


NESTED = [
    "()",
    "1 2.5 word [set] true false",
    "(1 2) (3 (4 (5 ()))) () (1.5 2.5) (a b) (1 a)",
    "{0 1 255} {}",
    '"" " " "a \\"quoted\\" word" "line\\nend" "tab\\tback\\\\slash"',
    "9999999999 -2147483648 2147483647 -2147483649",
]


def test_nested_lists_both_ways(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    """What is parsed there is what is parsed here, and arrives as it."""
    for text in NESTED:
        ours = Bottle.from_text(text)
        side.begin(f"bottle = yarp.Bottle({text!r})\nport.write(bottle)\nbottle.toString()")
        message = port.read(timeout=HANG)
        assert message.as_(Bottle) == ours
        assert bytes(message.payload) == spelled(cpp, ours.to_bytes())
        assert side.end() == ours.to_text()
        side.begin(
            f"bottle = read(yarp.Bottle())\n"
            f"[bottle.toString(), bottle.isEqual(yarp.Bottle({text!r}))]"
        )
        port.write(ours)
        assert side.end() == [ours.to_text(), True]


def test_single_values(side: CppProgram, port: yarpy.Port) -> None:
    """A Value sent by itself is a number or a word, not a list of one."""
    values = [("5", 5), ("2.5", 2.5), ("'a b'", "a b")]
    for make, value in values:
        side.begin(f"port.write(yarp.Value({make}))")
        assert port.read(timeout=HANG).value == value
        assert side.end()
        side.begin("read(yarp.Value()).toString()")
        port.write(value)
        assert side.end() == str(value)
        # The same message read as a list of one, and a list of one read as a value.
        side.begin("read(yarp.Bottle()).toString()")
        port.write(value)
        assert side.end() == Bottle([value]).to_text()


def test_vectors(side: CppProgram, port: yarpy.Port) -> None:
    numbers = [0.1, -2.5, 1e300, 0.0]
    side.begin(
        f"vector = yarp.Vector({len(numbers)})\n"
        f"for i, number in enumerate({numbers!r}): vector.set(i, number)\n"
        "port.write(vector)"
    )
    seen = port.read(timeout=HANG)
    assert side.end()
    assert isinstance(seen.value, Vector)
    assert seen.value == numbers
    assert seen.as_(np.ndarray).dtype == "float64"
    assert seen.as_(list) == numbers
    for sent in (Vector(numbers), np.array(numbers), numbers):
        side.begin("vector = read(yarp.Vector()); [vector.get(i) for i in range(vector.size())]")
        port.write(sent)
        assert side.end() == numbers
    side.begin(
        "vector = yarp.VectorInt()\nfor i in (5, -6): vector.push_back(i)\nport.write(vector)"
    )
    message = port.read(timeout=HANG)
    assert side.end()
    assert message.as_(np.ndarray).tolist() == [5, -6]
    assert message.as_(np.ndarray).dtype == "int32"
    side.begin("vector = read(yarp.VectorInt()); [vector.get(i) for i in range(vector.size())]")
    port.write(np.array([5, -6], "i4"))
    assert side.end() == [5, -6]
    # Large ones are views of what came, and leave as views of what there is.
    large = np.linspace(0, 1, 200_000)
    side.begin("vector = read(yarp.Vector()); port.write(vector); vector.size()")
    port.write(large)
    assert (port.read(timeout=HANG).as_(np.ndarray) == large).all()
    assert side.end() == len(large)


def test_matrices(side: CppProgram, port: yarpy.Port) -> None:
    array = np.arange(6.0).reshape(2, 3) / 8
    side.begin(
        "matrix = yarp.Matrix(2, 3)\n"
        "for i in range(6): matrix.set(i // 3, i % 3, i / 8)\n"
        "port.write(matrix)"
    )
    message = port.read(timeout=HANG)
    assert side.end()
    assert (message.as_(Matrix).array == array).all()
    assert (message.as_(np.ndarray) == array).all()
    for sent in (Matrix(array), array, array.T.copy().T):
        side.begin(
            "matrix = read(yarp.Matrix())\n"
            "[[matrix.get(r, c) for c in range(matrix.cols())] for r in range(matrix.rows())]"
        )
        port.write(sent)
        assert side.end() == array.tolist()


def test_sounds(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    """C++ 3.5 has the old form of a Sound; it is read like the new one, and sent on demand."""
    side.do(
        "def samples(sound): return [[sound.get(i, c) for i in range(sound.getSamples())]"
        " for c in range(sound.getChannels())]"
    )
    for channels, count in ((1, 1), (1, 4000), (2, 3), (3, 1000)):
        array = (np.arange(channels * count) * 37 - 1000).astype("i2").reshape(channels, count)
        sound = Sound(array, 44100)
        side.begin("sound = read(yarp.Sound()); [sound.getFrequency(), samples(sound)]")
        port.write(sound.to_bottle() if cpp.version < (3, 9) else sound)
        assert side.end() == [44100, array.tolist()]
        side.begin("port.write(sound)")
        assert port.read(timeout=HANG).as_(Sound) == sound
        assert side.end()


def test_properties(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    side.begin(
        "p = yarp.Property(); p.put('b', 2.5); p.put('a', 5); p.put('s', 'x y')\n"
        "p.addGroup('g').put('k', 1)\nport.write(p)"
    )
    message = port.read(timeout=HANG)
    assert side.end()
    assert message.as_(dict) == {"a": 5, "b": 2.5, "s": "x y", "g": ["k", 1]}
    assert spelled(cpp, message.as_(Property).to_bytes()) == bytes(message.payload)
    nested = {"a": 5, "b": 2.5, "s": "x y", "g": {"k": 1}}
    for sent in (nested, Property(nested)):
        side.begin(
            "p = read(yarp.Property())\n"
            "[p.find('a').asInt32(), p.find('b').asFloat64(), p.find('s').asString(),"
            " p.find('g').asList().find('k').asInt32(), p.toString()]"
        )
        port.write(sent)
        *values, text = side.end()
        assert values == [5, 2.5, "x y", 1]
        # Only a Property is nothing but that; of a dict there is said what it is in Python.
        said = "" if type(sent) is Property else " (yarpy.type (dict (g (dict))) 87)"
        assert text == f'(a 5) (b 2.5) (g ((k 1))) (s "x y"){said}'
    side.begin("p = read(yarp.Property()); [p.findGroup('g').find('k').asInt32(), p.toString()]")
    port.write(message.as_(Property))
    assert side.end() == [1, '(a 5) (b 2.5) (g (k 1)) (s "x y")']


def test_dicts_inside_lists(side: CppProgram, port: yarpy.Port) -> None:
    side.begin("b = yarp.Bottle('x'); b.addDict().put('k', 5); port.write(b)")
    assert port.read(timeout=HANG).value == ["x", {"k": 5}]
    assert side.end()
    side.begin(
        "b = read(yarp.Bottle()); [b.get(1).isDict(), b.get(1).asDict().find('k').asInt32()]"
    )
    port.write(["x", {"k": 5}])
    assert side.end() == [True, 5]


def test_stamps_as_messages(side: CppProgram, port: yarpy.Port) -> None:
    side.begin("port.write(yarp.Stamp(7, 8.25))")
    assert port.read(timeout=HANG).as_(Stamp) == Stamp(7, 8.25)
    assert side.end()
    side.begin("stamp = read(yarp.Stamp()); [stamp.getCount(), stamp.getTime()]")
    port.write(Stamp(7, 8.25))
    assert side.end() == [7, 8.25]


def test_text_carriers_carry_what_text_can(side: CppProgram) -> None:
    """Arrays as lists of numbers, maps as lists of pairs: what C++ reads off a text line."""
    with yarpy.Port("/ours") as port:
        port.connect("/cpp", "text_ack")
        side.begin("vector = read(yarp.Bottle()); vector.toString()")
        port.write(np.array([1.5, 2.5]))
        assert side.end() == "1.5 2.5"
        side.begin("read(yarp.Property()).toString()")
        port.write({"a": 1, "b": [1, 2]})
        assert side.end() == "(a 1) (b (1 2))"
        port.listen_to("/cpp", "text")
        side.begin("port.write(yarp.Bottle('1 (2.5 x) [set]'))")
        assert port.read(timeout=HANG).value == [1, [2.5, "x"], Vocab("set")]
        assert side.end()
