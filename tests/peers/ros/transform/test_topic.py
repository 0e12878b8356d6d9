"""Transforms of rospy's programs and ours, at /tf and /tf_static."""

import json
import logging

import pytest
from peers.ros.conftest import graph
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.peers.ros import Node, Transforms
from yarpy.peers.ros.transform.buffer import NoTransform

__all__ = ["graph"]

SAYS = """
import rospy, sys
from tf2_msgs.msg import TFMessage
from geometry_msgs.msg import TransformStamped
rospy.init_node("says", disable_signals=True)
moving = rospy.Publisher("/tf", TFMessage, queue_size=10)
fixed = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
def made(parent, child, x):
    found = TransformStamped()
    found.header.stamp = rospy.Time.now()
    found.header.frame_id, found.child_frame_id = parent, child
    found.transform.translation.x = x
    found.transform.rotation.w = 1.0
    return found
fixed.publish(TFMessage([made("base", "laser", 0.25)]))
print("ready", flush=True)
x = 0.0
while not rospy.is_shutdown():
    x += 1.0
    moving.publish(TFMessage([made("map", "base", x), made("base", "base", 1.0)]))
    rospy.sleep(0.05)
"""
HEARS = """
import json, rospy
from tf2_msgs.msg import TFMessage
rospy.init_node("hears", disable_signals=True)
def heard(message, fixed):
    for item in message.transforms:
        x, stamp = item.transform.translation.x, item.header.stamp.to_sec()
        said = [fixed, item.header.frame_id, item.child_frame_id, x, stamp]
        print(json.dumps(said), flush=True)
rospy.Subscriber("/tf", TFMessage, heard, False)
rospy.Subscriber("/tf_static", TFMessage, heard, True)
print('"ready"', flush=True)
rospy.spin()
"""


def test_what_rospy_says(graph: RosGraph, caplog: pytest.LogCaptureFixture) -> None:
    with graph.python(SAYS) as peer, Node("/listens") as node:
        wait_until(lambda: "ready" in peer.stdout)
        transforms = Transforms(node)
        first = transforms.lookup("map", "laser", timeout=HANG)
        assert first.pose.at[0] % 1 == pytest.approx(0.25)
        assert first.time == pytest.approx(node.now(), abs=2 * HANG)
        later = transforms.lookup("laser", "map", first.time + 0.06, timeout=HANG)
        assert later.pose.at[0] < -first.pose.at[0]
        with pytest.raises(NoTransform, match="no frame"):
            transforms.lookup("map", "nothing")
        wait_until(lambda: "cannot lie in itself" in caplog.text)
    assert caplog.text.count("cannot lie in itself") == 1  # once for all


def test_what_rospy_hears(graph: RosGraph) -> None:
    with Node("/tells") as node:
        transforms = Transforms(node)
        transforms.send("base", "left", (0.5, 0.0, 0.0), fixed=True)
        transforms.send("base", "right", (-0.5, 0.0, 0.0), fixed=True)
        assert transforms.lookup("left", "right").pose.at[0] == -1.0
        with graph.python(HEARS) as peer:
            wait_until(lambda: "ready" in peer.stdout)

            def heard() -> list[list[object]]:
                transforms.send("map", "base", (7.0, 0.0, 0.0), time=12.5)
                return [json.loads(line) for line in peer.stdout.splitlines()[1:]]

            wait_until(lambda: any(not item[0] for item in heard()))
            wait_until(lambda: len({str(item[2]) for item in heard()}) == 3)
            said = heard()
        assert [False, "map", "base", 7.0, 12.5] in said
        assert {(item[2], item[3]) for item in said if item[0]} == {("left", 0.5), ("right", -0.5)}


def test_what_makes_no_sense(graph: RosGraph, caplog: pytest.LogCaptureFixture) -> None:
    with Node("/wrong") as node, caplog.at_level(logging.WARNING):
        transforms = Transforms(node)
        for at, turned in (((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), ((1.0, 2.0), (0.0, 0.0, 0.0, 1.0))):
            with pytest.raises(ValueError):
                transforms.send("map", "base", at, turned)
        with pytest.raises(ValueError, match="in itself"):
            transforms.send("map", "map")


def test_time_that_begins_anew_forgets(graph: RosGraph, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    with Node("/simulated") as node:
        monkeypatch.setattr(node, "now", lambda: now[0])
        transforms = Transforms(node)
        transforms.send("map", "base")
        kind = node.publisher("/x", "tf2_msgs/TFMessage").type
        transforms.hear(kind(), False)
        assert transforms.can_transform("map", "base")
        now[0] = 5.0
        transforms.hear(kind(), False)
        assert not transforms.can_transform("map", "base")
