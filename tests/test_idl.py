"""`yarpy.idl.load`: types by name, without anything else to be set up."""

import subprocess
import sys

import pytest
from support.wait import HANG

import yarpy
from yarpy import idl


def test_messages_are_classes_that_ports_send() -> None:
    joints = idl.load("sensor_msgs/JointState")
    names = yarpy.LocalNames()
    with yarpy.Port("/w", names=names) as writer, yarpy.Port("/r", names=names) as reader:
        writer.connect("/r")
        writer.write(joints(name=["a"], position=[1.5]))
        message = reader.read(timeout=HANG)
        assert message is not None
        assert message.value.to_text() == '(0 (0 0) "") (a) (1.5) () ()'
        assert message.as_(joints).position.tolist() == [1.5]


def test_what_nobody_has() -> None:
    with pytest.raises(yarpy.UnknownType, match="nowhere/msg/Thing"):
        idl.load("nowhere/Thing")


def test_numpy_and_rosbags_come_when_they_are_needed() -> None:
    code = (
        "import sys, yarpy.peers.ros.message.library\nprint({'numpy', 'rosbags'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_thrift_without_lark_and_numpy_until_they_are_needed() -> None:
    code = "import sys; from yarpy.kits import thrift; print({'numpy', 'lark'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
