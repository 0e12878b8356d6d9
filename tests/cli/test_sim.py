"""`yarpy sim`."""

import signal

import pytest
from support.wait import wait_until

import yarpy

PATIENCE = 30.0


def test_robot_of_a_name(cli, names):
    words = ("--robot", "robbie", "--size", "64x48", "--fps", "50")
    with (
        cli.start("sim", *words) as process,
        yarpy.BufferedPort("/sim/eye", strict=True, names=names) as eye,
    ):
        ready = process.wait_line(r"^/robbie is ready: (.*)$", stream="out", timeout=PATIENCE)[1]
        assert ready == "/robbie/head /robbie/cam/left /robbie/cam/right /robbie/inertial"
        with yarpy.RpcClient("/robbie/head/rpc:i", names=names) as head:
            assert head.call("set", "pos", 1, 20) == ["ok"]
            wait_until(lambda: abs(head.call("get", "enc", 1)[2] - 20) < 0.01, PATIENCE)
        eye.listen_to("/robbie/cam/left")
        image = eye.read(timeout=PATIENCE).as_(yarpy.Image)
        assert (image.width, image.height) == (64, 48)
        process.signal(signal.SIGINT)
        assert process.wait() == 0, process.stderr
        assert "Traceback" not in process.stderr
    assert names.list("/robbie") == []


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--size", "big"), "'big' is no size; say 640x480"),
        (("--size", "5x5"), "from 16 to 2048 pixels"),
        (("--fps", "0"), "0.1<=x<=1000"),
    ],
)
def test_wrong_options(here, words, reason):
    said = here("sim", *words)
    assert said.code == 1
    assert reason in said.err


def test_name_that_is_taken(here, names):
    with yarpy.Port("/taken/head/rpc:i", names=names):
        said = here("sim", "--robot", "/taken")
    assert said.code == 1
    assert "is in use" in said.err
    assert names.list("/taken") == []
