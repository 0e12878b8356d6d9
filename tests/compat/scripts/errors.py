"""What wrong arguments raise."""

import yarp

b = yarp.Bottle("1")
p = yarp.Property()
for what in (
    "b.addString(3)",
    "b.addInt32('x')",
    "b.addInt32(2.5)",
    "b.addFloat64('x')",
    "b.addVocab('ab')",
    "b.addInt32(2**40)",
    "b.addInt8(200)",
    "b.nothing",
    "yarp.nothing",
    "p.put('v', [1])",
    "p.fromCommand(3)",
    "yarp.Port().open(3)",
    "yarp.Bottle(3)",
    "yarp.Port().write(3)",
    "b[0]",
    "len(b)",
    "yarp.Sound().set(40000, 0)",
    "yarp.DVector(1)[5]",
    "b.get(index=0).asInt32()",
    "b.addInt32(x=4)",
    "yarp.Matrix(1, 1)[0]",
):
    try:
        print(what, "->", eval(what))
    except Exception as error:
        print(what, "raises", type(error).__name__)
print(b.toString())
