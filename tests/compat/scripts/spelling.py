"""How numbers are spelled and read: doubles of every size, and text that may be a number."""

import yarp

DOUBLES = """0.0 -0.0 1.0 0.1 0.3333333333333333 1e10 1e15 1e16 1e17 1e20 1.5e-5 1e-4
    123456789.12345679 5e-324 1.7976931348623157e308 inf -inf nan 9007199254740992.0
    3.14159265358979 -2.5e-10 2147483647.5 2147483648.0 -2147483648.5 -2147483649.0"""
for word in DOUBLES.split():
    number = float(word)
    b = yarp.Bottle()
    b.addFloat64(number)
    b.addFloat32(number if abs(number) < 1e38 or number in (float("inf"), float("-inf")) else 1e38)
    p = yarp.Property()
    p.put("key", number)
    v = yarp.Value(number)
    print(word, b.toString(), p.toString(), v.toString(), yarp.Value_makeFloat64(number).toString())
    print(v.asInt8(), v.asInt16(), v.asInt32(), v.asInt64(), repr(v.asString()), v.asBool())
    again = yarp.Bottle(b.toString())
    first = again.get(0)
    print(again.size(), first.isFloat64(), first.isString(), first.isInt32(), first.asFloat64())

WORDS = """1. .5 -.5 +5 +5.5 1e5 1E5 1e 0x 0xff 0XFF -0x10 1_0 --1 1- inf nan -inf 1.5f 1,5 1;2 007
    2147483647 2147483648 -2147483648 -2147483649 9223372036854775807 9223372036854775808 0b1 1..2
    e5 1e400 1e-400 12abc 0x1p3 infinity 1e+5 - + . 1.0e0"""
for word in WORDS.split():
    b = yarp.Bottle(word)
    print(word, b.size(), [(b.get(i).getCode(), b.get(i).toString()) for i in range(b.size())])
    print(b.toString())
for word in ("1", "2147483648", "-5", "1.5", "abc", "true"):
    v = yarp.Value()
    v.fromString(word)
    print(word, v.getCode(), v.toString(), v.isInt32(), v.isInt64(), v.asInt32(), v.asInt64())
    print(v.asFloat64(), v.asBool(), v.asInt8(), v.asInt16())
for number in (0, 1, -1, 2**31 - 1, -(2**31)):
    v = yarp.Value(number)
    print(number, v.asBool(), v.asFloat64(), repr(v.asString()), v.asVocab32(), v.asInt8())
