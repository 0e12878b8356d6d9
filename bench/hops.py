"""One hop to a program of another system's own library, or to a port: by turns, in ratios.

    mqtt     paho publishes, mosquitto passes it on, paho hears: two hops there, two back; ports
             at the broker; and paho at ports, which is one hop there and one back
    dds      a String there and back over cyclonedds alone, with the types of that library, and
             over ports: the other side is of the same kind
    many     200 topics of ROS 2 over Zenoh at 50 Hz, from a node of one program to one of another

The other side is a program of its own. mosquitto comes from the system.

    python bench/hops.py [mqtt] [dds] [many]
"""

from __future__ import annotations

import contextlib
import os
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import yarpy
from yarpy.names.default import DEFAULT

TURNS = 5
COUNT = 400
FLOOD = 5000
TOPICS, RATE, SECONDS = 200, 50.0, 10.0
TEXT = "x" * 16
TYPE = "std_msgs/msg/String"
_LOOPBACK = (
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo' multicast='true'/>"
    "</Interfaces></General></Domain></CycloneDDS>"
)


def free() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        number: int = taken.getsockname()[1]
        return number


@contextlib.contextmanager
def other(*words: str) -> Iterator[subprocess.Popen[str]]:
    """This file as another program, once it says that it is ready, until its input ends."""
    pipe = subprocess.PIPE
    command = [sys.executable, __file__, "--answer", *words]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        assert process.stdout is not None and process.stdin is not None
        process.stdout.readline()
        yield process
        process.stdin.close()


def median_of(turn: Callable[[], None], count: int = COUNT) -> float:
    """The median of a round trip, in microseconds."""
    times = []
    for _ in range(10):
        turn()
    for _ in range(count):
        started = time.perf_counter()
        turn()
        times.append(time.perf_counter() - started)
    return statistics.median(times) * 1e6


# -- MQTT: a round trip of two topics, each over one or two hops -----------------------------------


def paho_client(number: int) -> Any:
    import paho.mqtt.client as paho

    client = paho.Client(paho.CallbackAPIVersion.VERSION2)
    client.connect("127.0.0.1", number)
    return client


@contextlib.contextmanager
def paho_turn(number: int, answers: bool) -> Iterator[Callable[[], None]]:
    """One side of a round trip by paho, at a broker."""
    come = threading.Semaphore(0)
    out, into = ("back", "there") if answers else ("there", "back")
    client = paho_client(number)

    def heard(_: Any, __: Any, message: Any) -> None:
        if answers:
            client.publish(out, message.payload)
        else:
            come.release()

    client.on_message = heard
    client.subscribe(into)
    client.loop_start()

    def turn() -> None:
        client.publish(out, TEXT)
        come.acquire()

    yield turn
    client.disconnect()
    client.loop_stop()


@contextlib.contextmanager
def port_turn(place: Callable[[str, bool], str], answers: bool) -> Iterator[Callable[[], None]]:
    """One side by ports; `place` says what a topic is called, and whether it is read."""
    out, into = ("back", "there") if answers else ("there", "back")
    with yarpy.Port("/answer" if answers else "/out") as writer:
        writer.connect(place(out, False))
        if answers:
            heard = lambda message: writer.write(message.value)  # noqa: E731
            with yarpy.Port("/answers", callback=heard) as reader:
                reader.listen_to(place(into, True))
                yield lambda: None
            return
        with yarpy.BufferedPort("/in", strict=True) as inlet:
            inlet.listen_to(place(into, True))

            def turn() -> None:
                writer.write(TEXT)
                _ = inlet.read(timeout=10).value

            yield turn


def mqtt_place(number: int) -> Callable[[str, bool], str]:
    return lambda topic, read: f"mqtt{'+sub' if read else ''}://127.0.0.1:{number}/{topic}"


@contextlib.contextmanager
def direct_turn() -> Iterator[Callable[[], None]]:
    """paho at a port of another program: it publishes to one, and reads the other."""
    with other("echo") as process:
        assert process.stdin is not None and process.stdout is not None
        into, out = map(int, process.stdout.readline().split())
        come = threading.Semaphore(0)
        reader, writer = paho_client(out), paho_client(into)
        reader.on_message = lambda *_: come.release()
        reader.subscribe("#")
        reader.loop_start()
        writer.loop_start()
        process.stdout.readline()  # somebody reads

        def turn() -> None:
            writer.publish("x", TEXT)
            come.acquire()

        yield turn
        for client in (reader, writer):
            client.disconnect()
            client.loop_stop()


def mqtt() -> None:
    program = shutil.which("mosquitto", path=os.environ["PATH"] + ":/usr/sbin")
    if program is None:
        sys.exit("no mosquitto: apt-get install mosquitto")
    number = free()
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "mosquitto.conf"
        config.write_text(
            f"listener {number} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\n", "utf-8"
        )
        broker = subprocess.Popen([program, "-c", str(config)], stderr=subprocess.DEVNULL)
        try:
            while socket.socket().connect_ex(("127.0.0.1", number)):
                time.sleep(0.05)
            found: dict[str, list[float]] = {"paho": [], "port": [], "direct": []}
            for _ in range(TURNS):
                with other("paho", str(number)), paho_turn(number, False) as turn:
                    found["paho"].append(median_of(turn))
                with other("mqtt", str(number)), port_turn(mqtt_place(number), False) as turn:
                    found["port"].append(median_of(turn))
                with direct_turn() as turn:
                    found["direct"].append(median_of(turn))
        finally:
            broker.terminate()
            broker.wait()
    shown("mqtt", found, "paho", {"paho": 4, "port": 4, "direct": 2})


def shown(
    name: str, found: dict[str, list[float]], base: str, hops: dict[str, int] | None = None
) -> None:
    """Print medians, and how they compare with the base, of each hop."""
    hops = hops or dict.fromkeys(found, 1)
    middle = {way: statistics.median(times) / hops[way] for way, times in found.items()}
    words = (f"{way} {middle[way]:6.0f} us ({middle[way] / middle[base]:.2f})" for way in found)
    print(f"{name:6} {'   '.join(words)}", flush=True)


# -- DDS ------------------------------------------------------------------------------------------


@contextlib.contextmanager
def cyclone_turn(answers: bool) -> Iterator[Callable[[], None]]:
    """One side by the library's own types, which it writes and reads itself."""
    from dataclasses import dataclass

    from cyclonedds.core import Listener, Policy, Qos
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import IdlStruct
    from cyclonedds.pub import DataWriter
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
    from cyclonedds.util import duration

    @dataclass
    class String_(IdlStruct, typename="std_msgs.msg.dds_.String_"):  # noqa: N801
        data: str

    String_.__annotations__ = {"data": str}
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
    come = threading.Semaphore(0)
    out, into = ("back", "there") if answers else ("there", "back")
    participant = DomainParticipant(1)  # that of ports is 0
    writer = DataWriter(participant, Topic(participant, f"rt/c_{out}", String_), qos)

    class Heard(Listener):  # type: ignore[misc]
        def on_data_available(self, reader: Any) -> None:
            for sample in reader.take(10):
                if not isinstance(sample, String_):
                    continue  # the other side has gone
                if answers:
                    writer.write(String_(sample.data))
                else:
                    come.release()

    topic = Topic(participant, f"rt/c_{into}", String_)
    listening = [DataReader(participant, topic, qos, listener=Heard())]

    def turn() -> None:
        writer.write(String_(TEXT))
        come.acquire()

    yield turn
    listening.clear()


def dds_place(topic: str, read: bool) -> str:
    return f"ros2+dds://p_{topic}~{TYPE}"


def dds() -> None:
    found: dict[str, list[float]] = {"cyclonedds": [], "port": []}
    for _ in range(TURNS):
        with other("cyclone"), cyclone_turn(False) as turn:
            time.sleep(1.0)  # both ends find each other
            found["cyclonedds"].append(median_of(turn))
        with other("dds"), port_turn(dds_place, False) as turn:
            time.sleep(1.0)
            found["port"].append(median_of(turn))
    shown("dds", found, "cyclonedds")


# -- many topics ----------------------------------------------------------------------------------


def publish() -> None:
    """Publish to all topics, at their rate, and say what that took."""
    from yarpy import ros2

    with ros2.Node("/many") as node:
        topics = [node.publisher(f"topic{number}", TYPE) for number in range(TOPICS)]
        print("ready", flush=True)
        sys.stdin.readline()
        started, used = time.perf_counter(), time.process_time()
        for step in range(int(RATE * SECONDS)):
            for topic in topics:
                topic.write(TEXT)
            left = started + (step + 1) / RATE - time.perf_counter()
            if left > 0:
                time.sleep(left)
        took = time.perf_counter() - started
        print(f"{(time.process_time() - used) / took:.3f} {took:.1f}", flush=True)
        sys.stdin.read()


def many() -> None:
    from yarpy import ros2
    from yarpy.peers.zenoh.router import open_router

    number = free()
    router = open_router([f"127.0.0.1:{number}"])
    os.environ["YARPY_ZENOH"] = f"127.0.0.1:{number}"
    count = 0

    def heard(_: Any) -> None:
        nonlocal count
        count += 1

    with other("publish") as process, ros2.Node("/reader") as node:
        assert process.stdin is not None and process.stdout is not None
        for topic in range(TOPICS):
            node.subscriber(f"/topic{topic}", TYPE, heard)
        time.sleep(3.0)  # all find each other
        used = time.process_time()
        process.stdin.write("go\n")
        process.stdin.flush()
        share, took = process.stdout.readline().split()
        read = (time.process_time() - used) / float(took)
        wanted = int(TOPICS * RATE * SECONDS)
    print(
        f"many   {TOPICS} topics at {RATE:.0f} Hz for {took} s: publisher {share} of a core, "
        f"subscriber and router {read:.3f}; {count} of {wanted} heard"
    )
    router.close()


# -- the other side -------------------------------------------------------------------------------


def echo() -> None:
    """A port that paho writes into, and one that it reads."""
    with (
        yarpy.Port("/out") as out,
        yarpy.Port("/in", callback=lambda message: out.write(message.value)) as into,
    ):
        print("ready", flush=True)
        print(into.contact.port, out.contact.port, flush=True)
        out.wait_for_outputs(timeout=20)
        print("read", flush=True)
        sys.stdin.read()


def answer(way: str, place: str) -> None:
    if way in ("echo", "publish"):
        {"echo": echo, "publish": publish}[way]()
        return
    sides: dict[str, Callable[[], contextlib.AbstractContextManager[Any]]] = {
        "paho": lambda: paho_turn(int(place), True),
        "mqtt": lambda: port_turn(mqtt_place(int(place)), True),
        "cyclone": lambda: cyclone_turn(True),
        "dds": lambda: port_turn(dds_place, True),
    }
    with sides[way]():
        print("ready", flush=True)
        sys.stdin.read()


def main() -> None:
    DEFAULT.push(yarpy.LocalNames())
    os.environ["CYCLONEDDS_URI"] = _LOOPBACK
    if sys.argv[1:2] == ["--answer"]:
        answer(sys.argv[2], sys.argv[-1])
        return
    for name in sys.argv[1:] or ["mqtt", "dds", "many"]:
        {"mqtt": mqtt, "dds": dds, "many": many}[name]()


if __name__ == "__main__":
    main()
