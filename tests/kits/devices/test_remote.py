"""Clients as devices of a robot's file."""

import pytest

import yarpy
from yarpy import Property
from yarpy.kits import devices
from yarpy.kits.devices import remote
from yarpy.registry import devices as plugins


@pytest.mark.parametrize(
    ("kind", "server", "device", "member"),
    [
        ("remote_controlboard", "controlBoard_nws_yarp", "fakeMotionControl", "axis_names"),
        ("frameGrabber_nwc_yarp", "frameGrabber_nws_yarp", "fakeFrameGrabber", "image"),
        ("battery_nwc_yarp", "battery_nws_yarp", "fakeBattery", "charge"),
        ("odometry2D_nwc_yarp", "odometry2D_nws_yarp", "fakeOdometry2D", "odometry"),
        ("JoypadControlClient", "JoypadControlServer", "fakeJoypad", "axis_count"),
    ],
)
def test_a_client_of_a_server(kind: str, server: str, device: str, member: str) -> None:
    names = yarpy.LocalNames()
    served = plugins.load(device)(Property(device=device), names=names)
    nws = plugins.load(server)(Property(device=server, name="/x"), names=names)
    nws.attach({"...": served})
    client = plugins.load(kind)(Property(device=kind, remote="/x", local="/me"), names=names)
    assert hasattr(client, member)
    client.close()
    nws.detach()


def test_every_type_of_the_table_is_known() -> None:
    for name in plugins.names():
        if plugins.load(name) is remote.remote:
            assert name in remote._CLASSES or remote._interface(name).NWC


def test_frames_are_served_and_asked_for() -> None:
    names = yarpy.LocalNames()
    server = remote.transform_server(Property(name="/tf"), names=names)
    client = remote.transforms(Property(remote="/tf"), names=names)
    assert isinstance(client, devices.TransformClient)
    client.close()
    server.close()  # type: ignore[attr-defined]


def test_a_remote_is_needed() -> None:
    with pytest.raises(ValueError, match="needs a parameter remote"):
        remote.remote(Property(device="remote_controlboard"), names=yarpy.LocalNames())
    with pytest.raises(yarpy.YarpError):
        remote.remote(
            Property(device="remote_controlboard", remote="/none"), names=yarpy.LocalNames()
        )
