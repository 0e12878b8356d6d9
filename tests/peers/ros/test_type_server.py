"""The type server: its words over both systems, and programs that learn from it."""

from pathlib import Path

import pytest
from support.port import free_port
from support.ros_graph import RosGraph

import yarpy
from yarpy.errors import UnknownType
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Folder, Standard
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.type_server import TypeClient, TypeServer

POSE = "float32 x\nfloat32 y\nfloat32 theta\nfloat32 v\nfloat32 w\n"
SPAWN = "Pose where\n---\nstring name\n"
CLIENT = """
import rospy
import struct, socket, rosgraph
host, port = rosgraph.network.parse_http_host_and_port(
    rosgraph.Master("/asking").lookupService("/typ").replace("rosrpc", "http"))
link = socket.create_connection((host, port))
fields = ["callerid=/asking", "md5sum=*", "persistent=1", "service=/typ"]
body = b"".join(struct.pack("<I", len(f)) + f.encode() for f in fields)
link.sendall(struct.pack("<I", len(body)) + body)
def take(count):
    data = b""
    while len(data) < count:
        data += link.recv(count - len(data))
    return data
fields = take(*struct.unpack("<I", take(4)))
print("header", b"type=test_roscpp/TestStringString" in fields, flush=True)
question = b"twiddle turtlesim/Pose"
link.sendall(struct.pack("<II", len(question) + 4, len(question)) + question)
ok = take(1)
answer = take(*struct.unpack("<I", take(4)))
print("said", ok, answer[4:].decode(), flush=True)
"""


@pytest.fixture
def library(tmp_path: Path) -> Library:
    package = tmp_path / "turtlesim"
    for kind, name, text in (
        *(("msg", "Pose", POSE), ("srv", "Spawn", SPAWN)),
        ("msg", "Broken", "what is\nthis?\n"),
    ):
        (package / kind).mkdir(parents=True, exist_ok=True)
        (package / kind / f"{name}.{kind}").write_text(text)
    return Library([Folder(tmp_path), Standard()])


def test_over_yarp(library: Library) -> None:
    names = yarpy.LocalNames()
    server = TypeServer("/typ", library, names)
    try:
        with yarpy.RpcClient("/typ", names=names) as client:
            assert client.call("twiddle", "turtlesim/Pose") == ["vector float32 5 *"]
            assert client.call(["twiddle turtlesim/Pose"]) == ["vector float32 5 *"]
            assert client.call("twiddle", "turtlesim/Spawn") == [
                "list 1 vector float32 5 * --- vector string 1 *"
            ]
            assert client.call("raw", "turtlesim/Pose") == [POSE]
            assert client.call("raw", "nothing/Known") == [""]
            for question in (["twiddle", "turtlesim/Broken"], ["help"], ["raw", "../x"], []):
                assert client.call(question) == ["?"], question
        learning = Library([TypeClient(names)])
        assert learning.service("turtlesim/Spawn").Request._full_text.endswith(POSE)
        learnt = learning.message("turtlesim/Pose")
    finally:
        server.close()
    assert learning.message("turtlesim/Pose") is learnt  # it keeps what it learnt
    with pytest.raises(UnknownType, match=r"the type server /typ \(`yarpy idl rosmsg --name"):
        learning.message("turtlesim/Color")


def test_over_ros_in_the_words_of_cpp(graph: RosGraph, library: Library) -> None:
    server = TypeServer("/typ@/yarpros", library)
    try:
        assert server.name == "/typ-1@/yarpros"
        with graph.python(CLIENT) as asking:
            asking.wait_line("header True")
            asking.wait_line(r"said b'\\x01' vector float32 5 \*")
        with Node("/ignorant") as node:
            pose = node.publisher("/poses", "turtlesim/Pose")
            assert pose.type._full_text == POSE
    finally:
        server.close()


def test_the_command(graph: RosGraph, library: Library, tmp_path: Path) -> None:
    served = graph.yarpy("idl", "rosmsg", "--folder", str(tmp_path), "--name", "/typ@/yarpros")
    with served:
        served.wait_line("/typ-1@/yarpros answers")
        assert "/typ" in graph.tool("rosservice", "list").split()
    served.stop()
    assert "/typ" not in graph.tool("rosservice", "list").split()


def test_rpc_asks_it_beside_a_yarp_server(
    graph: RosGraph, library: Library, tmp_path: Path
) -> None:
    """Which alone knows where the master is. Services of rospy tell nobody their definition."""
    (tmp_path / "turtlesim/srv/Greet.srv").write_text("string name\n---\nstring said\n")
    program = """
import rospy, sys
from genpy.dynamic import generate_dynamic
class Greet:
    _type = "turtlesim/Greet"
    _md5sum = sys.argv[1]
    _request_class = generate_dynamic(_type, "string name")[_type]
    _response_class = generate_dynamic(_type, "string said")[_type]
rospy.init_node("greeter", disable_signals=True)
rospy.Service("/greet", Greet, lambda asked: Greet._response_class("hello " + asked.name))
print("ready", flush=True)
rospy.spin()
"""
    beside = {"YARPY_SERVER": f"127.0.0.1:{free_port()}", "ROS_MASTER_URI": ""}
    number = beside["YARPY_SERVER"].rpartition(":")[2]
    server = TypeServer("/typ@/yarpros", library)
    try:
        with (
            graph.yarpy("server", "--ros", "--socket", number, "--ip", "127.0.0.1") as yarp,
            graph.python(program, library.service("turtlesim/Greet").md5sum) as greeter,
        ):
            yarp.wait_line("Ready!")
            greeter.wait_line("ready")
            with graph.yarpy("rpc", "/greet", **beside) as asking:
                asking.write_line("you")
                asking.wait_line('Response: "hello you"')
    finally:
        server.close()
