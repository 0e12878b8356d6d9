"""Ports whose names are those of topics: what their names must say."""

import pytest
from support.guest import guest
from support.wait import HANG

import yarpy
from yarpy.errors import AddressError
from yarpy.port.graph import find_role


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_MASTER_URI", raising=False)


def test_ordinary_names_have_no_role() -> None:
    for name in ("", "...", "/cam", "=x"):
        assert find_role(name, "", "", None) is None


def test_what_a_port_does_is_said_by_its_name_or_by_its_kind() -> None:
    guest("ros")
    names = yarpy.LocalNames()
    with pytest.raises(AddressError, match=r'"/t\+@/n" publishes it, "/t-@/n" subscribes to it'):
        yarpy.Port("/t@/n", names=names)
    with pytest.raises(AddressError, match="of which node"):
        yarpy.Port("/t+@", names=names)
    role = find_role("/t@/n~std_msgs/String", "-", "", names)
    assert role is not None
    assert role.port_name == "/t-@/n"
    assert role.declared.type == "std_msgs/String"


def test_without_a_master_they_are_ordinary_ports() -> None:
    guest("ros")
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/n=-/t", names=names, strict=True) as reader,
        yarpy.Port("/t+@/m", names=names) as writer,
        yarpy.RpcServer("/sum@/n", lambda message: [3], names=names) as server,
        yarpy.RpcClient("/sum-1@/n", name="/sum@/m", names=names) as client,
    ):
        assert (reader.name, server.name, client.name) == ("/t-@/n", "/sum-1@/n", "/sum+1@/m")
        writer.connect("/t-@/n")
        writer.write("hi")
        assert reader.read(timeout=HANG).value == "hi"
        assert client.call(1) == [3]


def test_the_environment_gives_a_port_its_role(monkeypatch: pytest.MonkeyPatch) -> None:
    guest("ros")
    monkeypatch.setenv("YARP_RENAME_icubSim_cam", "/icubSim/cam+@/icubSim")
    with yarpy.Port("/icubSim/cam", names=yarpy.LocalNames()) as port:
        assert port.name == "/icubSim/cam+@/icubSim"
