"""Buffered ports of several types, strict reading, callbacks."""

import time

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)

out = yarp.BufferedPortBottle()
inp = yarp.BufferedPortBottle()
print(inp.open("/in"), out.open("/out"))
inp.setStrict()
print(yarp.Network.connect("/out", "/in"))
for n in range(5):
    b = out.prepare()
    b.clear()
    b.addInt32(n)
    out.write(True)
print([inp.read().get(0).asInt32() for n in range(5)])
print(inp.read(False), inp.read(shouldWait=False))
out.prepare().clear()
out.writeStrict()
print(inp.read().size(), inp.lastRead().size())

v_in, v_out = yarp.BufferedPortVector(), yarp.BufferedPortVector()
v_in.open("/v/in")
v_out.open("/v/out")
yarp.Network.connect("/v/out", "/v/in")
v = v_out.prepare()
v.resize(3)
v[0] = 1.5
v.set(1, 2)
v_out.write()
got = v_in.read()
print(got.toString(), got.size(), got[0], got.get(2))

p_in, p_out = yarp.BufferedPortProperty(), yarp.BufferedPortProperty()
p_in.open("/p/in")
p_out.open("/p/out")
yarp.Network.connect("/p/out", "/p/in")
p_out.prepare().put("a", 1)
p_out.write()
print(p_in.read().find("a").asInt32())

s_in, s_out = yarp.BufferedPortSound(), yarp.BufferedPortSound()
s_in.open("/s/in")
s_out.open("/s/out")
yarp.Network.connect("/s/out", "/s/in")
s = s_out.prepare()
s.setFrequency(8000)
s.resize(3, 2)
s.set(7, 1, 1)
s_out.write()
s = s_in.read()
print(s.getSamples(), s.getChannels(), s.getFrequency(), s.get(1, 1), s.get(0))

i_in, i_out = yarp.BufferedPortImageRgb(), yarp.BufferedPortImageRgb()
i_in.open("/i/in")
i_out.open("/i/out")
yarp.Network.connect("/i/out", "/i/in")
image = i_out.prepare()
image.resize(5, 3)
image.zero()
image.pixel(4, 2).g = 200
i_out.write()
image = i_in.read()
print(image.width(), image.height(), image.pixel(4, 2).g, image.pixel(4, 2).r)


class Heard(yarp.BottleCallback):
    def onRead(self, bottle, *reader):
        print("callback", bottle.toString())
        got_it.append(True)


def wait(condition):
    for _ in range(1000):
        if condition():
            return
        time.sleep(0.01)
    print("waited in vain")


got_it = []
heard = Heard()
back = yarp.BufferedPortBottle()
back.useCallback(heard)
back.open("/back")
yarp.Network.connect("/out", "/back")
wait(lambda: back.getInputCount() == 1)
out.prepare().fromString("hi there")
out.write(True)
wait(lambda: got_it)
print(back.read(False))
back.disableCallback()
for port in (back, i_in, i_out, s_in, s_out, p_in, p_out, v_in, v_out, inp, out):
    port.close()
