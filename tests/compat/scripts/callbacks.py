"""Callbacks. (Those of images and vectors are never called by C++ 3.5.)"""

import time

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)


class OnSound(yarp.TypedReaderCallbackSound):
    def onRead(self, sound, *reader):
        print("sound", sound.getSamples(), sound.get(2))


class OnProperty(yarp.PropertyCallback):
    def onRead(self, values, *reader):
        print("property", values.toString())


kept = []


def told(kind, callback, fill):
    inp, out = getattr(yarp, "BufferedPort" + kind)(), getattr(yarp, "BufferedPort" + kind)()
    kept.append((inp, out, callback))
    inp.useCallback(callback)
    print(inp.open("/%s/in" % kind), out.open("/%s/out" % kind))
    print(yarp.Network.connect("/%s/out" % kind, "/%s/in" % kind))
    time.sleep(0.2)
    fill(out.prepare())
    out.write(True)
    time.sleep(0.5)


def fill_sound(sound):
    sound.resize(4)
    sound.set(7, 2)


told("Sound", OnSound(), fill_sound)
told("Property", OnProperty(), lambda values: values.put("a", 1))
for inp, out, _ in kept:
    out.close()
    inp.close()
