"""Moves a joint of a robot's head, as scripts for the iCub do.

python icub_head.py /icubSim/head
"""

import sys

import yarp

yarp.Network.init()
if not yarp.Network.checkNetwork():
    sys.exit("no name server")

props = yarp.Property()
props.put("device", "remote_controlboard")
props.put("local", "/client/head")
props.put("remote", sys.argv[1])
driver = yarp.PolyDriver(props)
if not driver.isValid():
    sys.exit("no robot")

encs = driver.viewIEncoders()
pos = driver.viewIPositionControl()
modes = driver.viewIControlMode()
limits = driver.viewIControlLimits()
info = driver.viewIAxisInfo()
axes = pos.getAxes()
print("axes", axes, info.getAxisName(0) != "")

vector = yarp.Vector(axes)
while not encs.getEncoders(vector.data()):
    yarp.delay(0.05)
doubles = yarp.DVector(axes)
print("encoders", encs.getEncoders(doubles), len(doubles), vector.size())

lowest, highest = yarp.DVector(1), yarp.DVector(1)
print("limits", limits.getLimits(0, lowest, highest), lowest[0] < highest[0])

print("mode", modes.setControlMode(0, yarp.VOCAB_CM_POSITION))
while modes.getControlMode(0) != yarp.VOCAB_CM_POSITION:
    yarp.delay(0.05)
print("speed", pos.setRefSpeed(0, 50.0), pos.setRefAcceleration(0, 1000.0))
goal = 10.0
print("move", pos.positionMove(0, goal))
while not pos.checkMotionDone(0):
    yarp.delay(0.05)
while abs(encs.getEncoder(0) - goal) > 1.0:
    yarp.delay(0.05)
print("there", abs(encs.getEncoder(0) - goal) < 1.0)

targets = yarp.DVector(axes, 0.0)
joints = yarp.IVector([0, 1])
print("modes", modes.setControlModes(2, joints, yarp.IVector([yarp.VOCAB_CM_POSITION] * 2)))
print("move two", pos.positionMove(2, joints, targets))
while not pos.checkMotionDone():
    yarp.delay(0.05)
got = yarp.IVector(axes)
print("all", modes.getControlModes(got), yarp.decode(got[0]))
print("stop", pos.stop(), pos.stop(0))
print("wrong", pos.positionMove(99, 1.0))
pids = driver.viewIPidControl()
pid = yarp.PidVector(1)
print("pid", isinstance(pids.getPid(yarp.VOCAB_PIDTYPE_POSITION, 0, pid), bool))
driver.close()
print("closed", driver.isValid())
yarp.Network.fini()
