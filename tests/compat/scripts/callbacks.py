"""Callbacks. (Those of images and vectors are never called by C++ 3.5.)"""

import time

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)


class OnSound(yarp.TypedReaderCallbackSound):
    def onRead(self, sound, *reader):
        print("sound", sound.getSamples(), sound.get(2))
        came.append("Sound")


class OnProperty(yarp.PropertyCallback):
    def onRead(self, values, *reader):
        print("property", values.toString())
        came.append("Property")


kept = []
came = []


def wait(condition):
    for _ in range(1000):
        if condition():
            return
        time.sleep(0.01)
    print("waited in vain")


def told(kind, callback, fill):
    inp, out = getattr(yarp, "BufferedPort" + kind)(), getattr(yarp, "BufferedPort" + kind)()
    kept.append((inp, out, callback))
    inp.useCallback(callback)
    print(inp.open("/%s/in" % kind), out.open("/%s/out" % kind))
    print(yarp.Network.connect("/%s/out" % kind, "/%s/in" % kind))
    wait(lambda: inp.getInputCount() == 1)
    fill(out.prepare())
    out.write(True)
    wait(lambda: kind in came)


def fill_sound(sound):
    sound.resize(4)
    sound.set(7, 2)


told("Sound", OnSound(), fill_sound)
told("Property", OnProperty(), lambda values: values.put("a", 1))
for inp, out, _ in kept:
    out.close()
    inp.close()
