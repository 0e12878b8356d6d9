"""ICartesianControl and IGazeControl, through PolyDriver, against the simulated arm and head."""

import pytest
from support.wait import wait_until

import yarp
from yarp import _names
from yarpy.kits import devices


@pytest.fixture
def alone():
    yarp.Network.setLocalMode(True)
    yield _names.names()
    yarp.Network.setLocalMode(False)


@pytest.fixture
def hand(alone):
    with devices.CartesianServer("/arm", devices.SimulatedArm(), 0.01, names=alone):
        driver = yarp.PolyDriver(
            "(device cartesiancontrollerclient) (remote /arm) (local /me) (carrier tcp)"
        )
        yield driver.viewICartesianControl()
        driver.close()


@pytest.fixture
def gaze(alone):
    with devices.GazeServer("/gaze", devices.SimulatedHead(), 0.01, names=alone):
        driver = yarp.PolyDriver(
            "(device gazecontrollerclient) (remote /gaze) (local /me) (carrier tcp)"
        )
        yield driver.viewIGazeControl()
        driver.close()


def near(found, wanted, by=1e-3):
    return all(abs(a - b) < by for a, b in zip(found, wanted, strict=True))


def test_a_hand(hand):
    x, o, q = yarp.Vector(), yarp.Vector(), yarp.Vector()
    wait_until(lambda: hand.getPose(x, o))
    assert (x.size(), o.size()) == (3, 4)
    goal = yarp.Vector([0.15, 0.05, -0.3])
    assert hand.goToPositionSync(goal, 0.02) and hand.waitMotionDone(0.01)
    wait_until(lambda: hand.getPose(x, o, yarp.Stamp()) and near(x, goal))
    assert hand.getPose(6, x, o) and near(x, goal) and hand.isMotionDone()
    assert hand.getDesired(x, o, q) and q.size() == 7
    assert hand.askForPosition(goal, x, o, q) and hand.askForPose(q, x, o, x, o, q)
    assert hand.askForPosition(q, goal, x, o, q) and hand.askForPose(x, o, x, o, q)
    assert hand.goToPose(x, o, 0.01) and hand.goToPoseSync(x, o, 0.01)
    assert hand.goToPosition(goal) and hand.stopControl()
    assert not hand.goToPosition(yarp.Vector(2))
    assert hand.setTaskVelocities(yarp.Vector(3), yarp.Vector(4))
    assert hand.getTaskVelocities(x, o) and hand.getJointsVelocities(q) and q.size() == 7


def test_settings_of_a_hand(hand):
    number, flag, low, high = yarp.DVector(1), yarp.BVector(1), yarp.DVector(1), yarp.DVector(1)
    kept = hand.storeContext()
    assert kept > 0 and hand.setTrajTime(2.0) and hand.getTrajTime() == 2.0
    assert hand.getTrajTime(number) and number[0] == 2.0
    assert hand.setInTargetTol(0.1) and hand.getInTargetTol() == 0.1
    assert hand.setTrackingMode(True) and hand.getTrackingMode(flag) and flag[0]
    assert hand.setReferenceMode(False) and not hand.getReferenceMode()
    assert hand.setPosePriority("orientation") and hand.getPosePriority() == "orientation"
    now = yarp.Vector()
    assert hand.setDOF(yarp.Vector([0.0] * 7), now) and [*now] == [0.0] * 7
    assert hand.getDOF(now) and hand.getRestPos(now) and hand.getRestWeights(now)
    assert hand.setRestPos(yarp.Vector([1.0] * 7), now) and now[6] == 1.0
    assert hand.setRestWeights(yarp.Vector([1.0] * 7), now)
    assert hand.setLimits(2, -5.0, 5.0) and hand.getLimits(2, low, high) and high[0] == 5.0
    assert not hand.setLimits(2, 5.0, -5.0)
    x, o = yarp.Vector([0.0, 0.0, -0.1]), yarp.Vector([0.0, 0.0, 1.0, 0.0])
    assert hand.attachTipFrame(x, o) and hand.getTipFrame(now, o) and near(now, x)
    assert hand.removeTipFrame() and hand.getTipFrame(now, o) and now[2] == 0.0
    assert hand.restoreContext(kept) and hand.getTrajTime() == 1.0
    assert hand.deleteContext(kept) and not hand.restoreContext(kept)
    info = yarp.Bottle()
    assert hand.getInfo(info) and info.find("server_version").asString() == "2.0"
    assert hand.tweakGet(info) and info.size() == 0 and not hand.tweakSet(yarp.Bottle("(a 1)"))


def test_events_of_a_hand(hand):
    heard = []

    class Done(yarp.CartesianEvent):
        def cartesianEventCallback(self) -> None:
            heard.append(self.cartesianEventVariables.type)

    event = Done()
    event.cartesianEventParameters.type = "motion-done"
    assert hand.registerEvent(event)
    goals = [yarp.Vector([0.15, 0.05, -0.3]), yarp.Vector([0.1, 0.0, -0.3])]

    def moved():
        hand.goToPositionSync(goals[0], 0.03)
        goals.reverse()
        return hand.waitMotionDone(0.01) and bool(heard)

    wait_until(moved)
    assert {*heard} == {"motion-done"} and hand.unregisterEvent(event)


def test_gaze(gaze):
    assert gaze.setNeckTrajTime(0.02) and gaze.getNeckTrajTime() == 0.02
    point, found, o = yarp.Vector([-0.5, 0.1, 0.35]), yarp.Vector(), yarp.Vector()
    assert gaze.lookAtFixationPointSync(point) and gaze.waitMotionDone(0.01)
    wait_until(lambda: gaze.getFixationPoint(found, yarp.Stamp()) and near(found, point))
    angles = yarp.Vector()
    assert gaze.getAnglesFrom3DPoint(point, angles) and angles.size() == 3
    assert gaze.get3DPointFromAngles(0, angles, found) and near(found, point)
    assert gaze.lookAtAbsAngles(yarp.Vector([0.0, 0.0, 4.0])) and gaze.checkSaccadeDone() in (0, 1)
    wait_until(lambda: gaze.getAngles(angles) and near(angles, (0.0, 0.0, 4.0)))
    left, right = yarp.Vector(), yarp.Vector()
    assert gaze.get2DPixel(0, point, left) and gaze.get2DPixel(1, point, right)
    assert gaze.triangulate3DPoint(left, right, found) and near(found, point)
    assert gaze.get3DPoint(0, left, 0.5, found) and near(found, point)
    plane = yarp.Vector([1.0, 0.0, 0.0, 0.5])
    assert gaze.get3DPointOnPlane(0, left, plane, found) and near(found, point)
    assert gaze.lookAtStereoPixelsSync(left, right) and gaze.lookAtStereoPixels(left, right)
    assert gaze.lookAtMonoPixel(0, left) and gaze.lookAtMonoPixelSync(1, right, 0.5)
    assert gaze.lookAtMonoPixelWithVergence(0, left, 5.0)
    assert gaze.lookAtMonoPixelWithVergenceSync(0, left, 5.0)
    assert gaze.lookAtRelAngles(yarp.Vector(3)) and gaze.lookAtRelAnglesSync(yarp.Vector(3))
    assert gaze.lookAtAbsAnglesSync(yarp.Vector([0.0, 0.0, 4.0])) and gaze.lookAtFixationPoint(
        point
    )
    assert gaze.waitMotionDone(0.01) and gaze.waitSaccadeDone(0.01) and gaze.stopControl()
    for pose in (gaze.getLeftEyePose, gaze.getRightEyePose, gaze.getHeadPose):
        assert pose(found, o, yarp.Stamp()) and o.size() == 4
    assert gaze.getJointsDesired(found) and found.size() == 6 and gaze.getJointsVelocities(found)


def test_settings_of_gaze(gaze):
    low, high = yarp.DVector(1), yarp.DVector(1)
    for name in ("EyesTrajTime", "VORGain", "OCRGain", "SaccadesInhibitionPeriod"):
        assert getattr(gaze, f"set{name}")(0.5) and getattr(gaze, f"get{name}")() == 0.5
    for name in ("SaccadesActivationAngle", "NeckAngleUserTolerance"):
        assert getattr(gaze, f"set{name}")(2.0) and getattr(gaze, f"get{name}")(low) and low[0] == 2
    for name in ("SaccadesMode", "StabilizationMode", "TrackingMode"):
        assert getattr(gaze, f"set{name}")(True) and getattr(gaze, f"get{name}")()
    for joint in ("Pitch", "Roll", "Yaw"):
        assert getattr(gaze, f"bindNeck{joint}")(-5.0, 5.0)
        assert getattr(gaze, f"getNeck{joint}Range")(low, high) and high[0] == 5.0
        assert getattr(gaze, f"blockNeck{joint}")(1.0) and getattr(gaze, f"clearNeck{joint}")()
    assert gaze.blockNeckPitch() and gaze.blockEyes(3.0) and gaze.getBlockedVergence() == 3.0
    assert gaze.blockEyes() and gaze.clearEyes() and gaze.getBlockedVergence() < 0
    kept, options = gaze.storeContext(), yarp.Bottle()
    assert gaze.restoreContext(kept) and gaze.deleteContext(kept) and gaze.getInfo(options)
    assert gaze.setStereoOptions(yarp.Bottle("(Kp 1)")) and gaze.getStereoOptions(options)
    assert options.toString() == "(Kp 1)" and gaze.tweakGet(options)
