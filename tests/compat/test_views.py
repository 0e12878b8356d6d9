"""Parts of INavigation2D, points between frames, modes and controllers of joints."""

import pytest

import yarp


@pytest.fixture
def alone():
    yarp.Network.setLocalMode(True)
    yield
    yarp.Network.setLocalMode(False)


class Robot:
    """Somebody who is in a kitchen, and knows its areas."""

    def __init__(self) -> None:
        self.places = {"sink": yarp.Map2DLocation("kitchen", 1.0, 1.2, 0.0)}
        self.areas = {
            "hall": yarp.Map2DArea("house", [(0, 0), (1, 0), (1, 1)]),
            "corner": yarp.Map2DArea("kitchen", [(0, 0), (2, 0), (2, 2), (0, 2)]),
        }

    def go(self, place):
        """Go nowhere."""

    def position(self):
        return yarp.Map2DLocation("kitchen", 1.0, 1.0, 0.0)._outgoing()

    def location(self, name):
        return self.places[name]._outgoing()

    def area_names(self):
        return [*self.areas]

    def area(self, name):
        return self.areas[name]._outgoing()


def test_where_a_robot_is() -> None:
    driver = yarp.PolyDriver()
    driver.give(Robot())
    view = driver.viewINavigation2D()
    assert isinstance(view, yarp.INavigation2DTargetActions)
    assert isinstance(view, yarp.INavigation2DVelocityActions)
    inside = yarp.BVector(1)
    assert view.checkInsideArea("corner") and not view.checkInsideArea("hall")
    assert view.checkInsideArea("hall", inside) and not inside[0]
    assert not view.checkInsideArea("nowhere", inside)
    assert view.checkNearToLocation("sink", 0.5) and not view.checkNearToLocation("sink", 0.1)
    there = yarp.Map2DLocation("kitchen", 1.0, 1.0, 90.0)
    assert not view.checkNearToLocation(there, 0.5, 10.0)
    assert view.checkNearToLocation(there, inside, 0.5) and inside[0]
    name, area = yarp.SVector(1), yarp.Map2DArea()
    assert view.findCurrentArea(name, area) and name[0] == "corner" and len(area.points) == 4


def test_statuses() -> None:
    for name in ("idle", "moving", "error"):
        code = getattr(yarp, f"navigation_status_{name}")
        assert yarp.statusToString(code) == f"navigation_status_{name}"
        assert yarp.stringToStatus(f"navigation_status_{name}") == code
    assert yarp.statusToString(5) == "navigation_status_error"
    assert yarp.stringToStatus("bogus") == yarp.navigation_status_error


def test_points_between_frames(alone) -> None:
    server = yarp.PolyDriver("(device frameTransformServer)")
    driver = yarp.PolyDriver("(device frameTransformClient) (local /me)")
    frames = driver.viewIFrameTransform()
    matrix, out = yarp.Matrix(4, 4), yarp.Vector()
    matrix.eye()
    matrix[0, 3] = 2.0
    assert not frames.waitForTransform("hand", "base", 0.0)
    assert frames.setTransformStatic("hand", "base", matrix)
    assert frames.waitForTransform("hand", "base", 30.0)
    assert frames.transformPoint("hand", "base", yarp.Vector([1.0, 2.0, 3.0]), out)
    assert [*out] == [3.0, 2.0, 3.0]
    assert not frames.transformPoint("hand", "base", yarp.Vector(2), out)
    assert yarp.IFrameTransform.TRANSFORM_TIMEOUT == 2
    driver.close()
    server.close()


def test_modes_and_controllers_of_a_joint() -> None:
    class Pids:
        gains = [(1.0,) * 10]
        offsets = [0.5]

    class Joint:
        axis_names = ["one"]
        pids = {"pos": Pids()}

        def encoders(self):
            return [0.0]

        def position_move(self, joints, positions):
            """Move nowhere."""

    found = yarp.IVector()
    assert yarp.IControlMode(Joint()).getAvailableControlModes(0, found)
    assert [*found] == [yarp.encode(word) for word in ("pos", "idl", "fidl")]
    assert not yarp.IControlMode(Joint()).getAvailableControlModes(1, found)
    view, number = yarp.IPidControl(Joint()), yarp.DVector(1)
    assert view.getAvailablePids(0, found) and [*found] == [yarp.VOCAB_PIDTYPE_POSITION]
    assert view.getPidOffset(yarp.VOCAB_PIDTYPE_POSITION, 0, number) and number[0] == 0.5
    assert view.setPidFeedforward(yarp.VOCAB_PIDTYPE_POSITION, 0, 2.5)
    assert view.getPidFeedforward(yarp.VOCAB_PIDTYPE_POSITION, 0, number) and number[0] == 2.5
    assert yarp.PidWithExtraInfo().pid.kp == 0.0
