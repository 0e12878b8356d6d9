"""Topics of ROS 2: a port against eclipse-zenoh alone, with the same bytes over the same router.

Round trips between two programs, which do it in each way by turns, so that a busy machine is as
unkind to each; a ratio compares medians of the same turn, and the middle one of these counts. Two
ways without a port put finished CDR and an attachment, and copy out the bytes that come: `direct`
hears inside Zenoh's own thread (`indirect=False`), where nothing may wait; `bare` hears as
eclipse-zenoh does by default, who asks by `recv`, who answers by a function. `by_hand` is `bare` in
a program that has values, not bytes: it makes each message of a value and takes it apart again, by
`struct`, `join` and `frombuffer`. `port` writes a value to a port and reads an object
of the type from another. Then a flood of small messages to a program that counts them.

    python bench/ros2_topic.py [text | picture | flood] ...
"""

from __future__ import annotations

import contextlib
import os
import socket
import statistics
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import yarpy
from yarpy.names.default import DEFAULT
from yarpy.peers import ros2
from yarpy.peers.ros2.kind import key_of
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import close, share

TURNS = 40
ANSWER = "answer"  # the word that starts the other program
FLOOD = 20_000
SHAPE = (480, 640, 3)
TYPES = {"text": "std_msgs/msg/String", "picture": "sensor_msgs/msg/Image"}


def value_of(what: str) -> Any:
    if what == "text":
        return "x" * 16
    return yarpy.Image(np.zeros(SHAPE, "u1"))


def body_of(what: str) -> bytes:
    kind = ros2.load(TYPES[what])
    if what == "text":
        return b"".join(kind(data="x" * 16).to_ros())
    pixels = np.zeros(480 * 640 * 3, "u1")
    blocks = kind(height=480, width=640, encoding="rgb8", step=1920, data=pixels).to_ros()
    return b"".join(blocks)


class Bytes:
    """Messages are finished bytes, with one attachment for all."""

    def __init__(self, what: str) -> None:
        self.value: Any = body_of(what)
        self._attached = attachment(1, 1, bytes(16))

    def make(self, value: Any) -> tuple[bytes, bytes]:
        """Return the message for a value, and its attachment."""
        return value, self._attached

    def read(self, sample: Any) -> Any:
        """Return the value of a message."""
        return sample.payload.to_bytes()


class ByHand:
    """Messages are made of a text or an array of pixels, and taken apart."""

    def __init__(self, what: str) -> None:
        self._number, self._text = 0, what == "text"
        self._start = body_of(what)[: -SHAPE[0] * SHAPE[1] * SHAPE[2]]
        self.value: Any = "x" * 16 if self._text else np.zeros(SHAPE, "u1")

    def make(self, value: Any) -> tuple[bytes, bytes]:
        """Return the message for a value, and its attachment."""
        self._number += 1
        now = time.time_ns()
        attached = _ATTACHMENT.pack(self._number, now, 16, bytes(16))
        if self._text:
            data = value.encode()
            return b"\0\1\0\0" + _LENGTH.pack(len(data) + 1) + data + b"\0", attached
        stamp = _STAMP.pack(*divmod(now, 1_000_000_000))
        return b"".join((self._start[:4], stamp, self._start[12:], value.data)), attached

    def read(self, sample: Any) -> Any:
        """Return the value of a message."""
        _ATTACHMENT.unpack(sample.attachment.to_bytes())
        data = sample.payload.to_bytes()
        if self._text:
            return data[8:-1].decode()
        return np.frombuffer(data, "u1", offset=len(self._start)).reshape(SHAPE)


_ATTACHMENT = struct.Struct("<qqB16s")
_LENGTH = struct.Struct("<I")
_STAMP = struct.Struct("<iI")


def key(way: str, what: str) -> str:
    return str(key_of(0, f"/{way}_{what}", ros2.load(TYPES[what]), False))


@contextlib.contextmanager
def alone(what: str, answers: bool, way: str) -> Iterator[Callable[[], None]]:
    """One side by eclipse-zenoh alone; what is returned makes a round trip."""
    from zenoh.handlers import Callback

    out, into = ("back", "there") if answers else ("there", "back")
    direct = way == "direct"
    come = threading.Semaphore(0)
    form = ByHand(what) if way == "by_hand" else Bytes(what)
    with share() as shared:
        publisher = shared.session.declare_publisher(key(f"{way}_{out}", what))

        def heard(sample: Any) -> None:
            value = form.read(sample)
            if answers:
                data, attached = form.make(value)
                publisher.put(data, attachment=attached)
            else:
                come.release()

        where = key(f"{way}_{into}", what)
        if direct:
            hears = shared.session.declare_subscriber(where, Callback(heard, indirect=False))
        elif answers:
            hears = shared.session.declare_subscriber(where, heard)
        else:
            hears = shared.session.declare_subscriber(where)

        def turn() -> None:
            data, attached = form.make(form.value)
            publisher.put(data, attachment=attached)
            if direct:
                come.acquire()
            else:
                form.read(hears.recv())

        yield turn
        hears.undeclare()
        publisher.undeclare()


@contextlib.contextmanager
def port(what: str, answers: bool) -> Iterator[Callable[[], None]]:
    """One side by ports."""
    out, into = ("back", "there") if answers else ("there", "back")
    with yarpy.Port("/answer" if answers else "/out") as writer:
        writer.connect(f"ros2://{out}_{what}~{TYPES[what]}")
        if answers:
            # What came is decoded, as an object of its type, and that is sent.
            heard = lambda message: writer.write(message.ros)  # noqa: E731
            with yarpy.Port("/answers", callback=heard) as reader:
                reader.listen_to(f"ros2://{into}_{what}~{TYPES[what]}")
                yield lambda: None
            return
        value = value_of(what)
        with yarpy.BufferedPort("/in", strict=True) as reader2:
            reader2.listen_to(f"ros2://{into}_{what}~{TYPES[what]}")

            def turn() -> None:
                writer.write(value)
                _ = reader2.read(timeout=10).ros

            yield turn


WAYS = {
    **{way: partial(alone, way=way) for way in ("direct", "bare", "by_hand")},
    "port": port,
}


def answer(what: str) -> None:
    """The other program."""
    with contextlib.ExitStack() as stack:
        for made in WAYS.values():
            stack.enter_context(made(what, True))
        print("ready", flush=True)
        sys.stdin.read()


def measure(what: str, count: int) -> None:
    found: dict[str, list[float]] = {way: [] for way in WAYS}
    pipe = subprocess.PIPE
    command = [sys.executable, __file__, ANSWER, what]
    with (
        subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as other,
        contextlib.ExitStack() as stack,
    ):
        assert other.stdout is not None and other.stdin is not None
        stack.callback(other.stdin.close)
        other.stdout.readline()
        turns = {way: stack.enter_context(made(what, False)) for way, made in WAYS.items()}
        time.sleep(1.0)  # both ends find each other
        for _ in range(TURNS):
            for way, turn in turns.items():
                turn(), turn()
                times = []
                for _ in range(count):
                    started = time.perf_counter()
                    turn()
                    times.append(time.perf_counter() - started)
                found[way].append(statistics.median(times) * 1e6)
    shown = "   ".join(f"{way} {statistics.median(times):.0f}" for way, times in found.items())
    ratios = []
    for way in ("direct", "bare", "by_hand"):
        pairs = zip(found["port"], found[way], strict=True)
        ratios.append(f"{statistics.median(ours / base for ours, base in pairs):.2f} x {way}")
    print(f"{what:8} there and back, us: {shown}   port: {', '.join(ratios)}", flush=True)


def flood() -> None:
    """How many small messages a second leave, and arrive, in this program."""
    from zenoh.handlers import Callback

    body, attached = body_of("text"), attachment(1, 1, bytes(16))
    with share() as shared:
        count = 0

        def heard(sample: Any) -> None:
            nonlocal count
            sample.payload.to_bytes()
            count += 1

        hears = shared.session.declare_subscriber(
            key("flood", "text"), Callback(heard, indirect=False)
        )
        publisher = shared.session.declare_publisher(key("flood", "text"))
        started = time.perf_counter()
        for _ in range(FLOOD):
            publisher.put(body, attachment=attached)
        first = FLOOD / (time.perf_counter() - started)
        publisher.undeclare()
        kind = ros2.load(TYPES["text"])
        with yarpy.Port("/flood") as writer:
            writer.connect(f"ros2://flood_text~{TYPES['text']}")
            value = kind(data="x" * 16)
            started = time.perf_counter()
            for _ in range(FLOOD):
                writer.write(value)
            second = FLOOD / (time.perf_counter() - started)
        hears.undeclare()
    print(f"text     written: bare {first:.0f}/s   port {second:.0f}/s   ({count} heard)")


def main() -> None:
    DEFAULT.push(yarpy.LocalNames())
    wanted = sys.argv[1:] or ["text", "picture", "flood"]
    if wanted[0] == ANSWER:
        answer(wanted[1])
        return
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        number = free.getsockname()[1]
    router = open_router([f"127.0.0.1:{number}"])
    os.environ["YARPY_ZENOH"] = f"127.0.0.1:{number}"
    for what in wanted:
        if what == "flood":
            flood()
        else:
            measure(what, 40 if what == "text" else 15)
    close(router)


if __name__ == "__main__":
    main()
