"""Moves joints of two boards as one, as scripts for whole bodies do.

python remapper.py /robot/torso /robot/head eyes yaw
"""

import sys

import yarp

yarp.Network.init()
options = yarp.Property()
options.put("device", "remotecontrolboardremapper")
options.put("localPortPrefix", "/script")
for key, words in (("remoteControlBoards", sys.argv[1:3]), ("axesNames", sys.argv[3:])):
    options.fromString(f"({key} ({' '.join(words)}))", False)
driver = yarp.PolyDriver(options)
print("open", driver.isValid())

encoders, position = driver.viewIEncoders(), driver.viewIPositionControl()
count = encoders.getAxes()
print("axes", count, driver.viewIAxisInfo().getAxisName(0))
targets = yarp.Vector(count)
targets.set(0, 5.0)
targets.set(1, 6.0)
print("move", position.positionMove(targets.data()))
values = yarp.Vector(count)
while not encoders.getEncoders(values.data()) or (values.get(0), values.get(1)) != (5.0, 6.0):
    yarp.delay(0.02)
print("there", values.get(0))
driver.close()

options.unput("axesNames")
print("wrong", yarp.PolyDriver(options).isValid())
