"""Objects stay where they were put."""

import pytest

import yarpy
from yarpy.kits.devices.interfaces.world import Colour, Description, Pose, World
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated import world as module
from yarpy.kits.devices.simulated.world import DescriptionStorage, SimulatedWorld
from yarpy.nameserver.local import LocalNames


def test_over_the_network(names: LocalNames) -> None:
    simulated = SimulatedWorld()
    with (
        World.serve("/world", simulated, names=names),
        World.connect("/world", names=names) as world,
    ):
        world.make_sphere("ball", 0.1, Pose(1.0, yaw=0.5), Colour(255, 0, 0))
        world.make_box("box", 1.0, 2.0, 3.0, Pose(), Colour(), "table", gravity=True)
        assert world.objects() == ["ball", "box"] and world.pose("ball") == Pose(1.0, yaw=0.5)
        assert simulated.things["box"].gravity and simulated.things["box"].frame == "table"
        with pytest.raises(yarpy.LocalProtocolError, match='"/world" refuses pose'):
            world.pose("cup")


def test_objects(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WORLD_OBJECTS", 4)
    world = SimulatedWorld()
    world.make_cylinder("a", 1.0, 2.0, Pose(), Colour())
    world.make_frame("b", 1.0, Pose(), Colour(), "table")
    world.make_model("c", "cup.sdf", Pose(2.0))
    world.make_actor("d", "skin", "walk", Pose())
    with pytest.raises(Refused, match="no more"):
        world.make_actor("e", "skin", "walk", Pose())
    with pytest.raises(Refused, match="there is a 'a'"):
        world.make_actor("a", "skin", "walk", Pose())
    with pytest.raises(Refused, match="placed in the frame 'table'"):
        world.pose("b")
    world.place("b", Pose(1.0))
    world.paint("b", Colour(1, 2, 3))
    world.enable_gravity("b", True)
    world.enable_collision("b", False)
    world.attach("b", "hand")
    found = world.things["b"]
    assert (found.gravity, found.collision, found.link, found.colour.g) == (True, False, "hand", 2)
    world.detach("b")
    world.delete("a")
    world.rename("b", "z")
    assert found.link == "" and world.objects() == ["c", "d", "z"]
    world.clear()
    with pytest.raises(Refused, match="no 'z'"):
        world.delete("z")


def test_descriptions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WORLD_OBJECTS", 2)
    storage = DescriptionStorage()
    storage.register(Description("head", "board"))
    storage.register(Description("eye", "camera"))
    for name, why in (("head", "there is a device"), ("arm", "no more")):
        with pytest.raises(Refused, match=why):
            storage.register(Description(name))
    assert [each.device_name for each in storage.devices_of("camera")] == ["eye"]
    storage.unregister("eye")
    with pytest.raises(Refused, match="no device 'eye'"):
        storage.unregister("eye")
    storage.clear()
    assert storage.devices() == []
