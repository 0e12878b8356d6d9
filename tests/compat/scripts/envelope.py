"""Envelopes: they stay until there is another, and are read as stamps or as words."""

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)
plain, buffered, target = yarp.Port(), yarp.BufferedPortBottle(), yarp.BufferedPortBottle()
target.setStrict(True)
for port, name in ((plain, "/plain"), (buffered, "/buffered"), (target, "/target")):
    port.open(name)


def read():
    target.read()
    stamp, words = yarp.Stamp(9, 9.5), yarp.Bottle("old")
    print(target.getEnvelope(stamp), stamp.getCount(), stamp.getTime(), stamp.isValid())
    print(target.getEnvelope(words), words.toString())


ENVELOPES = [
    None,
    yarp.Stamp(5, 1.25),
    None,
    yarp.Stamp(6, 2.0),
    yarp.Bottle("3 4.5"),
    yarp.Bottle('hello "big world"'),
    yarp.Bottle("7"),
    yarp.Bottle(""),
    yarp.Stamp(),
    yarp.Bottle("1 2 3"),
    yarp.Stamp(-1, 3.0),
    yarp.Stamp(2147483647, 1e9),
    yarp.Bottle("(1 2)"),
    yarp.Stamp(1, 1 / 3),
    yarp.Stamp(1, 1700000000.123456),
]
yarp.Network.connect("/plain", "/target")
for envelope in ENVELOPES:
    if envelope is not None:
        print(plain.setEnvelope(envelope))
    plain.write(yarp.Bottle("x"))
    read()
yarp.Network.disconnect("/plain", "/target")
yarp.Network.connect("/buffered", "/target")
for envelope in ENVELOPES:
    if envelope is not None:
        print(buffered.setEnvelope(envelope))
    message = buffered.prepare()
    message.clear()
    message.addString("x")
    buffered.write(True)
    read()

stamp = yarp.Stamp(2147483646, 1.0)
stamp.update(2.0)
print(stamp.getCount())
stamp.update(3.0)
print(stamp.getCount(), stamp.getTime())
stamp = yarp.Stamp()
stamp.update()
print(stamp.isValid(), stamp.getCount(), stamp.getTime() > 1e9)
words = yarp.Bottle()
print(yarp.Portable.copyPortable(yarp.Stamp(3, 1.5), words), words.toString())
for text in ("4 2.5", "", "4", "a b", "4 2", "4.5 2.5", "(4 2.5)", "[a] 1.0"):
    stamp = yarp.Stamp(8, 8.0)
    print(text, yarp.Portable.copyPortable(yarp.Bottle(text), stamp), stamp.isValid())
