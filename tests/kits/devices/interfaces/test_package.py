"""The list of interfaces."""

from yarpy.kits.devices.interfaces import WHERE, interfaces


def test_interfaces() -> None:
    found = interfaces()
    assert [*found] == [*WHERE] == sorted(WHERE)
    for name, interface in found.items():
        assert interface.__name__ == name and interface.__doc__ and interface.NWS
        functions = [each.function for each in interface.members.values() if each.function]
        assert len(functions) == len({*functions})
