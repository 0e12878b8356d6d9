"""The benchmark of ROS topics runs; how fast they are is not tested."""

import sys
from pathlib import Path

import pytest
from support.port import free_block

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import ros  # noqa: E402


@pytest.mark.peer("ros", "rosmaster")
def test_every_pair(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", ["ros.py", "--seconds", "0.2"])
    for name in ("ROS_MASTER_URI", "ROS_IP", "YARPY_SERVER"):
        monkeypatch.setenv(name, "")
    monkeypatch.setenv("YARP_PORT_RANGE", str(free_block(200)))  # at the usual one may be a demo
    ros.main()
    table = capsys.readouterr().out
    for name in ("text", "image"):
        assert f"{name:6} rospy " in table
