"""Round trips over topics of ROS: yarpy beside rospy, with the same messages and the same master.

One program publishes on /ping and waits for what another one, of the same kind, sends back on
/pong; `mixed` is yarpy asking and rospy answering. Both sides make the message anew and look into
it, as programs do. A master, rospy and the messages are taken from the system (apt-get install
python3-rosmaster python3-rospy python3-sensor-msgs). yarpy runs in the system's Python too where
that is of the same version: that of a distribution is compiled with more care than one's own.

    python bench/ros.py [--seconds 5]
"""

from __future__ import annotations

import argparse
import os
import socket
import statistics
import subprocess
import sys
import time
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
SYSTEM = "/usr/bin/python3"
SIZES = {"text": 0, "image": 1_000_000}  # bytes of pixels
PATIENCE = 10.0

# What runs in the system's Python: `rospy echo SIZE` or `rospy ask SIZE SECONDS`.
ROSPY = r"""
import queue, sys, time, rospy
from sensor_msgs.msg import Image
from std_msgs.msg import String
role, size = sys.argv[1], int(sys.argv[2])
kind = Image if size else String
rospy.init_node("rospy_" + role, disable_signals=True)
topic = "/pong" if role == "echo" else "/ping"
out = rospy.Publisher(topic, kind, queue_size=None, tcp_nodelay=True)
def made(data):
    if not size:
        return String(data)
    return Image(height=1000, width=size // 1000, step=size // 1000, encoding="mono8", data=data)
if role == "echo":
    rospy.Subscriber("/ping", kind, lambda m: out.publish(made(m.data)), tcp_nodelay=True)
    print("ready", flush=True)
    rospy.spin()
else:
    got = queue.SimpleQueue()
    rospy.Subscriber("/pong", kind, lambda m: got.put(len(m.data)), tcp_nodelay=True)
    while not out.get_num_connections():
        time.sleep(0.01)
    time.sleep(1)
    data, times, end = (b"\1" * size if size else "hello"), [], time.time() + float(sys.argv[3])
    while time.time() < end:
        start = time.perf_counter()
        out.publish(made(data))
        got.get(timeout=10)
        times.append(time.perf_counter() - start)
    print(*times, flush=True)
"""


def node(role: str, size: int) -> tuple[Any, Any, Any]:
    """A node of yarpy, its publisher and the class of its messages."""
    import yarpy.idl
    import yarpy.peers.ros

    kind = yarpy.idl.load("sensor_msgs/Image" if size else "std_msgs/String")
    own = yarpy.ros.Node(f"/yarpy_{role}")
    return own, own.publisher("/pong" if role == "echo" else "/ping", kind), kind


def made(kind: Any, size: int, data: Any) -> Any:
    """A message."""
    if not size:
        return kind(data)
    return kind(height=1000, width=size // 1000, step=size // 1000, encoding="mono8", data=data)


def echo(size: int) -> None:
    """Send back what comes."""
    own, out, kind = node("echo", size)
    own.subscriber("/ping", kind, lambda message: out.write(made(kind, size, message.data)))
    print("ready", flush=True)
    sys.stdin.read()
    own.close()


def ask(size: int, seconds: float) -> list[float]:
    """Seconds for each round trip."""
    import numpy as np

    own, out, kind = node("ask", size)
    with own:
        answers = own.subscriber("/pong", kind)
        if not (out.wait_for_outputs(timeout=PATIENCE) and answers.wait_for_inputs(1, PATIENCE)):
            raise SystemExit("nobody echoes")
        time.sleep(1)
        data = np.ones(size, "u1") if size else "hello"
        times, end = [], time.time() + seconds
        while time.time() < end:
            start = time.perf_counter()
            out.write(made(kind, size, data))
            assert len(answers.take(PATIENCE).data) == len(data)
            times.append(time.perf_counter() - start)
    return times


def measure(asker: str, echoer: str, size: int, seconds: float) -> list[float]:
    """Seconds for each round trip from a program of one kind to one of another and back."""
    with subprocess.Popen(
        command(echoer, "echo", size),
        env=environment(echoer),
        stdout=subprocess.PIPE,
        stdin=subprocess.PIPE,
        text=True,
    ) as other:
        assert other.stdout is not None and other.stdin is not None
        assert other.stdout.readline() == "ready\n"
        words = [*command(asker, "ask", size), str(seconds)]
        said = subprocess.run(
            words, env=environment(asker), capture_output=True, text=True, timeout=seconds + 60
        )
        other.kill()
    if said.returncode:
        raise SystemExit(said.stderr)
    return [float(word) for word in said.stdout.split()]


def command(kind: str, role: str, size: int) -> list[str]:
    """How a program of a kind is started."""
    if kind == "rospy":
        return [SYSTEM, "-c", ROSPY, role, str(size)]
    return [interpreter(), __file__, "--role", role, str(size)]


def environment(kind: str) -> dict[str, str]:
    """Variables for a program of a kind: ours needs our packages."""
    if kind == "rospy":
        return dict(os.environ)
    packages = [str(ROOT / "src"), *(path for path in sys.path if "site-packages" in path)]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(packages)}


@cache
def interpreter() -> str:
    """The Python for yarpy: the system's, if it is of the version that our packages are for."""
    code = "import sys; print(sys.version_info[:2])"
    said = subprocess.run([SYSTEM, "-c", code], capture_output=True, text=True)
    return SYSTEM if said.stdout == f"{sys.version_info[:2]}\n" else sys.executable


def run(seconds: float) -> dict[str, dict[str, float]]:
    """The median of each pair of programs in microseconds, by message."""
    found: dict[str, dict[str, float]] = {}
    for message, size in SIZES.items():
        for asker, echoer in (("rospy", "rospy"), ("yarpy", "yarpy"), ("yarpy", "rospy")):
            name = asker if asker == echoer else "mixed"
            times = measure(asker, echoer, size, seconds)
            found.setdefault(message, {})[name] = statistics.median(times) * 1e6
    return found


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=5.0, help="for each pair")
    parser.add_argument("--role", nargs="+", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.role:
        size = int(given.role[1])
        echo(size) if given.role[0] == "echo" else print(*ask(size, float(given.role[2])))
        return
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}/", ROS_IP="127.0.0.1")
    os.environ.pop("YARPY_SERVER", None)
    with subprocess.Popen(
        [SYSTEM, "/usr/bin/rosmaster", "--core", "-p", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as master:
        time.sleep(2)
        try:
            for message, row in run(given.seconds).items():
                shown = ", ".join(f"{name} {value:.0f} us" for name, value in row.items())
                print(
                    f"{message:6} {shown}; yarpy takes {row['yarpy'] / row['rospy']:.2f} of rospy"
                )
        finally:
            master.terminate()


if __name__ == "__main__":
    main()
