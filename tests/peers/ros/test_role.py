"""Which master and which name service a member has."""

import pytest
from support.port import free_port

import yarpy
from yarpy.errors import NoNameServer
from yarpy.names.fallback_client import SeveralNames
from yarpy.names.node_name import NodeName
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.names import RosNames
from yarpy.peers.ros.role import role_of, services, without_masters


@pytest.fixture(autouse=True)
def place(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_SERVER", "YARP_NAMESPACE", "ROS_MASTER_URI"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))


def test_the_master_is_among_the_names_or_in_the_environment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    local, masters = yarpy.LocalNames(), RosNames(RosMaster("http://a:1/"))
    assert services(local) == (local, None)
    both = SeveralNames([local, masters])
    assert services(both) == (both, masters.master)
    assert without_masters(both) is local
    assert without_masters(masters) is None
    monkeypatch.setenv("ROS_MASTER_URI", "http://b:2")
    names, master = services(local)
    assert names is local and master is not None and master.uri == "http://b:2/"
    assert services(None)[0] is None


def test_neither_is_an_error() -> None:
    with pytest.raises(NoNameServer, match="for ROS, set ROS_MASTER_URI"):
        services(None)


def test_an_unknown_type_is_taken_from_the_peers(caplog: pytest.LogCaptureFixture) -> None:
    role = role_of(NodeName("/n", "/t", "+", "nothing/Known"), "", yarpy.LocalNames())
    assert role.declared.kind is None and role.declared.type == "nothing/Known"
    assert "the type is taken from who connects" in caplog.text
    role = role_of(NodeName("/n", "/t", "+"), "yarp/image", yarpy.LocalNames())
    assert role.member.shown_type == "sensor_msgs/Image"
    assert role.declared.kind._type == "sensor_msgs/Image"


def test_a_configured_server_that_does_not_answer_is_done_without(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{free_port()}")
    monkeypatch.setenv("ROS_MASTER_URI", "http://b:2")
    names, master = services(None)
    assert names is None and master is not None
