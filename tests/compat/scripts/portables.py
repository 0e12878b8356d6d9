"""One thing written, another read: what fits, and what does not."""

import threading

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)
out, inp = yarp.Port(), yarp.Port()
inp.open("/in")
out.open("/out")
yarp.Network.connect("/out", "/in")


def passed(written, read, show):
    writer = threading.Thread(target=out.write, args=(written,))
    writer.start()
    print(inp.read(read), show(read))
    writer.join()


passed(yarp.Bottle("1 2"), yarp.Bottle(), lambda b: b.toString())
passed(yarp.Bottle("1.5 2.5"), yarp.Vector(), lambda v: v.toString())
passed(yarp.Bottle("(a 1) (b 2)"), yarp.Property(), lambda p: p.toString())
passed(yarp.Property("(a 1) (b 2)"), yarp.Bottle(), lambda b: b.toString())
passed(yarp.Stamp(3, 4.5), yarp.Bottle(), lambda b: b.toString())
passed(yarp.Value(3), yarp.Bottle(), lambda b: b.toString())
vector = yarp.Vector([1, 2.5])
passed(vector, yarp.Vector(), lambda v: v.toString())
passed(vector, yarp.Bottle(), lambda b: b.toString())
matrix = yarp.Matrix(2, 2)
matrix.set(0, 1, 3.5)
passed(matrix, yarp.Matrix(), lambda m: (m.rows(), m.cols(), m.get(0, 1)))
sound = yarp.Sound()
sound.resize(3, 2)
sound.set(7, 1, 1)
sound.setFrequency(8000)
passed(sound, yarp.Sound(), lambda s: (s.getSamples(), s.get(1, 1), s.getFrequency()))
out.close()
inp.close()
