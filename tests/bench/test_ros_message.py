"""The benchmark of ROS messages runs; how fast they are is not tested."""

import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import ros_message  # noqa: E402


def test_table(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("rosbags")
    monkeypatch.setattr(sys, "argv", ["ros_message.py", "--rounds", "1"])
    monkeypatch.setattr(sys, "path", [*sys.path])
    ros_message.main()
    table = capsys.readouterr().out
    for name in ("std_msgs/String", "sensor_msgs/JointState", "sensor_msgs/Image"):
        assert f"| {name} | yarpy | " in table
