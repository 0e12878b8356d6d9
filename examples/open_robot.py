"""One robot, four worlds: ZeroMQ, MQTT, ROS 2 and Zenoh see its camera and its joints at once.

In four terminals; the robot is a program of its own, and stays as it is (docs/open-robot.md):

    yarpy server
    yarpy router
    yarpy sim
    python examples/open_robot.py
"""

import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from queue import Queue
from typing import Any

import simplejpeg
import zenoh
import zenoh_ros2_sdk
import zmq
from rosbags.typesys import Stores, get_typestore

import yarpy

HOST, NUMBER = os.environ.get("YARPY_ZENOH", "tcp/127.0.0.1:7447").removeprefix("tcp/").split(":")
os.environ["ZENOH_CONFIG_OVERRIDE"] = 'mode="client"'  # of zenoh_ros2_sdk
TYPES = get_typestore(Stores.ROS2_JAZZY)  # of messages, for ROS 2 and Zenoh


def zeromq(port: Any, topic: str, kind: str) -> Any:
    with zmq.Context() as context, context.socket(zmq.SUB) as socket:
        socket.linger, socket.rcvtimeo = 0, 20_000
        socket.connect(f"tcp://{port.address}")
        socket.subscribe(b"")
        return decoded(socket.recv_multipart()[1])


def mqtt(port: Any, topic: str, kind: str) -> Any:
    words = f"mosquitto_sub -h {port.host} -p {port.port} -t # -C 1 -N -W 20"
    return decoded(subprocess.run(words.split(), check=True, stdout=subprocess.PIPE).stdout)


def decoded(payload: bytes) -> Any:
    return json.loads(payload) if payload[:1] == b"[" else simplejpeg.decode_jpeg(payload).shape


def ros2(port: Any, topic: str, kind: str) -> Any:
    text, heard = TYPES.generate_msgdef(kind, ros_version=2)[0], Queue[Any]()
    place = {"router_ip": HOST, "router_port": int(NUMBER), "type_hash": TYPES.hash_rihs01(kind)}
    zenoh_ros2_sdk.ROS2Subscriber(f"/{topic}", kind, heard.put, text, **place)
    return fields(heard.get(timeout=20))


def zenoh_client(port: Any, topic: str, kind: str) -> Any:
    place = {"mode": "client", "connect": {"endpoints": [f"tcp/{HOST}:{NUMBER}"]}}
    heard = Queue[Any]()
    with zenoh.open(zenoh.Config.from_json5(json.dumps(place))) as session:
        session.declare_subscriber(f"0/{topic}/**", heard.put)
        return fields(TYPES.deserialize_cdr(heard.get(timeout=20).payload.to_bytes(), kind))


def fields(message: Any) -> Any:
    if hasattr(message, "width"):
        return message.height, message.width, 3
    return message.data.tolist()


with ThreadPoolExecutor() as pool:
    for name, kind in (
        ("/icubSim/cam/left", "sensor_msgs/msg/Image"),
        ("/icubSim/head/state:o", "std_msgs/msg/Float64MultiArray"),
    ):
        topic, port = name.strip("/").replace(":", "_"), yarpy.query(name)
        yarpy.connect(name, f"ros2://{topic}")
        worlds = {w: pool.submit(w, port, topic, kind) for w in (zeromq, mqtt, ros2, zenoh_client)}
        for world, seen in worlds.items():
            print(f"{name:22} {world.__name__:13} {list(seen.result())}", flush=True)
os._exit(0)  # zenoh_ros2_sdk has threads that would go on
