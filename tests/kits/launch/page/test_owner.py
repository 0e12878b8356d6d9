"""Which program has which port."""

import os

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.page.owner import AT_ONCE, Owners, claimed
from yarpy.kits.launch.supervise import process

CAMERA = Module("camera", "yarpdev", "--device grabber --name /cam")
VIEW = Module("view", "yarpview", "--name=/cam/view", prefix="")
ARM = Module("arm", "arm", "--name /arm", prefix="/left")


@pytest.mark.parametrize(
    ("port", "label"),
    [
        ("/cam", "camera"),
        ("/cam/rpc", "camera"),
        ("/cam/view", "view"),
        ("/camera", ""),
        ("/left/arm/state", "arm"),
        ("/arm/state", ""),
    ],
)
def test_what_a_command_line_claims(port: str, label: str) -> None:
    assert claimed(port, [CAMERA, VIEW, ARM, Module("sh", "sh", "/ -c x")]) == label


@pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
def test_a_port_says_itself_whose_it_is(network: yarpy.LocalNames) -> None:
    mine = {os.getsid(0): "tests"}
    owners = Owners(lambda: mine, names=network)
    with yarpy.Port("/cam/rpc", names=network):
        there = {"/cam/rpc", "/gone"}
        wait_until(lambda: owners.find(["/cam/rpc", "/gone"], there, [CAMERA]) == ["tests", ""])
        assert owners.find(["/cam/rpc"], set(), [CAMERA]) == ["tests"]  # it is remembered
        mine.clear()
        assert owners.find(["/cam/rpc"], there, [CAMERA]) == ["camera"]


def test_few_are_asked_at_once() -> None:
    asked: list[str] = []
    owners = Owners(lambda: {1: "a"}, lambda port: len(asked.append(port) or ""))
    ports = [f"/p{number}" for number in range(20)]
    assert owners.find(ports, {*ports}, []) == [""] * 20
    assert len(asked) == AT_ONCE
