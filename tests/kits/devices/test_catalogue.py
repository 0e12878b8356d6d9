"""The list of the types of devices."""

from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.catalogue import PURPOSES, catalogue, lines
from yarpy.registry import Registry
from yarpy.shipped import SHIPPED


class Arm:
    """An arm of six joints.

    Moves slowly."""


class Bare:
    pass


class Broken(Registry):
    def load(self, name: str) -> object:
        raise UnknownPlugin(name)


def test_every_type_that_ships_has_a_purpose() -> None:
    assert PURPOSES.keys() == SHIPPED["devices"].keys()
    assert all(PURPOSES.values())
    assert not [name for name, purpose in PURPOSES.items() if len(purpose) > 75]


def test_every_server_that_is_named_exists() -> None:
    for purpose in PURPOSES.values():
        _, _, server = purpose.partition("served by ")
        assert not server or server in PURPOSES


def test_types_of_others_say_what_they_are() -> None:
    plugins = Registry("devices", {})
    plugins.add("zArm", Arm)
    plugins.add("bare", Bare)
    found = dict(catalogue(plugins))
    assert found["zArm"] == "An arm of six joints"
    assert found["bare"] == ""
    broken = Broken("devices", {})
    broken.add("arm", Arm)
    assert dict(catalogue(broken))["arm"] == "does not load: yarpy dev arm says why"


def test_lines_are_in_two_columns_and_sorted() -> None:
    said = lines()
    assert len(said) == len(catalogue())
    names = [line.split()[0].lower() for line in said]
    assert names == sorted(names)
    shipped = [line for line in said if line.split()[0] in PURPOSES]
    assert len({line.index(PURPOSES[line.split()[0]]) for line in shipped}) == 1
