"""Joints that are at once where they are sent."""

from yarpy.kits.devices.simulated.joints import SimulatedJoints


def test_what_is_braked_does_not_move() -> None:
    joints = SimulatedJoints(["yaw", "roll"])
    joints.apply_brakes([1], [True])
    joints.position_move([0, 1], [5.0, 5.0])
    joints.velocity_direct([0], [1.0])
    assert joints.encoders() == [5.0, 0.0] and joints.braked() == [False, True]


def test_members() -> None:
    joints = SimulatedJoints(["yaw", "roll"])
    joints.position_move([1], [5.0])
    joints.position_direct([0], [500.0])
    joints.velocity_move([0], [5.0])
    joints.stop([0])
    assert joints.encoders() == [180.0, 5.0] and joints.encoder_speeds() == [0.0, 0.0]
    joints.switch_control_modes([0, 1], ["vel", "fidl"])
    assert joints.control_modes() == ["vel", "idl"]
    joints.switch_interaction_modes([0], ["comp"])
    assert joints.interaction_modes() == ["comp", "stif"] and all(joints.motion_done())


def test_controllers_as_those_of_cpp() -> None:
    joints = SimulatedJoints(["yaw", "roll"])
    joints.pids["vel"].targets = [1.0, 2.0]
    found = {kind: (pids.errors()[1], pids.outputs()[1]) for kind, pids in joints.pids.items()}
    assert found == {"pos": (0.1, 11.1), "vel": (0.2, 11.2), "cur": (0.3, 11.3), "trq": (0.4, 11.4)}
    assert joints.pids["pos"].targets == [0.0, 0.0] and joints.pids["vel"].targets == [1.0, 2.0]
