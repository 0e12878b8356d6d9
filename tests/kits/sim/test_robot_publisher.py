"""Guests in which a simulated robot is shown: found by name, and with every member."""

from yarpy import registry
from yarpy.kits.sim.robot_publisher import RobotPublisher


def test_guests_have_what_the_robot_needs() -> None:
    members = {name for name in vars(RobotPublisher) if not name.startswith("_")} | {"title"}
    assert registry.robots.names()
    for name in registry.robots.names():
        guest = registry.robots.load(name)()
        assert [member for member in members if not hasattr(guest, member)] == []
