"""Every kind of element, seen through every method of Value."""

import yarp

b = yarp.Bottle()
b.addInt8(-5)
b.addInt16(300)
b.addInt32(70000)
b.addInt64(2**40 + 3)
b.addFloat32(2.7)
b.addFloat64(-3.9)
b.addString("hello")
b.addString("12")
b.addVocab32("set")
b.addList().addInt32(1)
b.addDict().put("a", 1)
b.append(yarp.Bottle('true false {1 2 3} [a] () "" 0 0.0'))
NAMES = [
    "asBool",
    "asInt8",
    "asInt16",
    "asInt32",
    "asInt64",
    "asFloat32",
    "asFloat64",
    "asString",
    "asVocab32",
    "asInt",
    "asDouble",
    "asVocab",
    "asBlobLength",
    "getCode",
    "toString",
    "toString_c",
    "isBool",
    "isInt8",
    "isInt16",
    "isInt32",
    "isInt64",
    "isFloat32",
    "isFloat64",
    "isString",
    "isVocab32",
    "isBlob",
    "isList",
    "isDict",
    "isLeaf",
    "isNull",
    "isInt",
    "isDouble",
    "isVocab",
]
for i in range(b.size() + 1):
    v = b.get(i)
    for name in NAMES:
        print(i, name, repr(getattr(v, name)()))
print([b.find(k).toString() for k in ("hello", "12", "set", "1", "a", "true")])
print(b.check("1"), repr(b.findGroup("a").toString()), b.findGroup("hello").isNull())
print(b.toString())
print(yarp.Bottle(b).toString())

print(yarp.Value("x").asString(), yarp.Value(3).asInt32(), yarp.Value(3.5).asFloat64())
print(yarp.Value_makeInt32(4).asInt32(), yarp.Value.makeString("a b").toString())
print(yarp.Value(True).toString(), yarp.Value("set", True).asVocab32())
print(yarp.Value_makeValue("(1 2)").asList().size(), yarp.Value_makeList("1 2").toString())
print(yarp.Value().isNull(), repr(yarp.Value().toString()))
print(yarp.Value(3).isEqual(yarp.Value(3)), yarp.Value(3).notEqual(yarp.Value(4)))
print(yarp.Value_makeFloat64(1).isFloat64(), yarp.Value_makeVocab32("ok").toString())
print(yarp.Value_getNullValue().isNull(), b.get(1).asList(), b.get(0).asDict())
v = yarp.Value()
v.fromString("(1 (a 2))")
print(v.toString(), v.check("a"), v.find("a").asInt32(), v.findGroup("a").toString())
