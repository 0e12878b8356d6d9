"""Topics and services over a router: between ports of ours, and with an independent node."""

import contextlib
import json
import logging
import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.process import Process
from support.ros2_peer import peer_command, peer_environment
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.kind import key_of
from yarpy.peers.ros2.zenoh import endpoint as module
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.participant import Participant, take_part
from yarpy.peers.ros2.zenoh.subscriber import Subscriber
from yarpy.peers.zenoh.transport import share

zenoh = pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
String = ros2.load("std_msgs/msg/String")
ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture
def part(names: yarpy.LocalNames) -> Iterator[Participant]:
    """What the graph looks like."""
    found = take_part(0)
    yield found
    found.close()


class Peer(Process):
    """A node of the other implementation."""

    def __init__(self, router: int, home: Path, *words: str) -> None:
        super().__init__(peer_command(router, *words), env=peer_environment(home))

    def ready(self) -> "Peer":
        try:
            wait_until(lambda: "ready" in self.said, 2 * HANG)
        except AssertionError:
            raise AssertionError(
                f"the peer is not ready: {self.returncode} {self.stderr}"
            ) from None
        return self

    @property
    def said(self) -> list[object]:
        return [json.loads(line) for line in self.stdout.splitlines()]


def written(out: yarpy.Port, reader: yarpy.BufferedPort, value: object) -> yarpy.Message:
    """The next message, once both ends have found each other."""
    deadline = time.monotonic() + HANG
    while time.monotonic() < deadline:
        out.write(value)
        try:
            return reader.read(timeout=0.2)
        except yarpy.Timeout:
            continue
    raise AssertionError("nothing came")


# -- between ports --------------------------------------------------------------------------------


def test_a_picture(part: Participant) -> None:
    pixels = np.arange(12, dtype="u1").reshape(2, 2, 3)
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in") as reader:
        reader.listen_to("ros2://camera/image")
        out.connect("ros2://camera/image")
        found = written(out, reader, yarpy.Image(pixels))
        assert np.array_equal(found.as_(yarpy.Image).array, pixels)
        assert found.ros._type == "sensor_msgs/Image"  # type: ignore[attr-defined]
        assert found.stamp is not None
        assert abs(found.stamp.time - time.time()) < 2 * HANG
        assert reader.stats.inputs[0].bytes > 12


def test_the_envelope_is_the_time_of_the_header(part: Participant) -> None:
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        out.connect("ros2://joints~sensor_msgs/msg/JointState")
        reader.listen_to("ros2://joints")
        written(out, reader, yarpy.Vector([1.0]))
        out.write(yarpy.Vector([1.0, 2.0]), yarpy.Stamp(5, 12.25))
        while (found := reader.read(timeout=HANG)).as_(yarpy.Vector).array.size < 2:
            pass
        assert found.ros.header.stamp.sec == 12  # type: ignore[attr-defined]
        assert found.stamp is not None
        assert found.stamp.time == 12.25


@pytest.mark.parametrize("type_", ["", "~std_msgs/msg/String"])
def test_who_comes_late_gets_what_was_latched(part: Participant, type_: str) -> None:
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        out.connect("ros2+qos.latched://map~std_msgs/msg/String")
        out.write("first")
        out.write("last")
        wait_until(lambda: part.graph.endpoints("/map", "MP"))
        reader.listen_to(f"ros2://map{type_}")  # it sees that the publisher keeps messages
        assert reader.read(timeout=HANG).value == "last"
        out.write("next")
        assert reader.read(timeout=HANG).value == "next"


def test_a_publisher_that_keeps_messages_and_comes_late(part: Participant) -> None:
    """Its subscriber asks for what was kept from then on, and takes each message once."""
    with (
        yarpy.Port("/out") as out,
        yarpy.Port("/map") as keeps,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        reader.listen_to("ros2://map~std_msgs/msg/String")
        out.connect("ros2+qos.default://map~std_msgs/msg/String")
        written(out, reader, "plain")
        (ours,) = part.graph.endpoints("/map", "MS")
        assert not ours.qos.latched
        keeps.connect("ros2+qos.latched://map~std_msgs/msg/String")
        keeps.write("first")
        keeps.write("second")

        def asks() -> bool:
            return [token.qos.latched for token in part.graph.endpoints("/map", "MS")] == [True]

        wait_until(asks)
        keeps.write("end")
        found = [reader.read(timeout=HANG).value]
        while found[-1] != "end":
            found.append(reader.read(timeout=HANG).value)
        assert [text for text in found if text != "plain"] == ["first", "second", "end"]


@pytest.mark.parametrize("type_", ["", "~std_msgs/msg/String"])
def test_a_publisher_keeps_messages_where_one_asks_for_them(part: Participant, type_: str) -> None:
    """It stays reliable, whatever the first subscriber asks for."""
    with (
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/sensor") as sensor,
        yarpy.BufferedPort("/map") as asks,
    ):
        sensor.listen_to("ros2+qos.sensor://both~std_msgs/msg/String")
        asks.listen_to("ros2+qos.latched://both~std_msgs/msg/String")
        wait_until(lambda: len(part.graph.endpoints("/both", "MS")) == 2)
        out.connect(f"ros2://both{type_}")
        wait_until(lambda: part.graph.endpoints("/both", "MP"))
        (ours,) = part.graph.endpoints("/both", "MP")
        assert (ours.qos.reliable, ours.qos.latched, ours.qos.depth) == (True, True, 10)


def test_a_service(part: Participant) -> None:
    def add(message: yarpy.Message) -> object:
        asked = message.ros  # type: ignore[attr-defined]
        if asked.a < 0:
            raise ValueError("only what is positive")
        return [asked.a + asked.b]

    with yarpy.RpcServer("/server", add) as server:
        server.listen_to(f"ros2://add~{ADD}")
        with yarpy.RpcClient("ros2://add", name="/client") as client:
            answer = client.ask([5, 37])
            assert answer is not None
            assert answer.ros.sum == 42  # type: ignore[attr-defined]
            assert client.ask({"a": 1, "b": 2}).value == 3  # type: ignore[union-attr]
            refused = client.ask([-1, 2])
            assert refused is not None
            assert "only what is positive" in refused.as_(yarpy.Bottle).to_text()
            with pytest.raises(yarpy.DecodeError, match="expected an integer"):
                client.ask(["x", 2])
        kinds = {token.kind for token in part.graph.endpoints("/add", "SS", "SC")}
        assert "SS" in kinds


def test_a_server_that_went_away(part: Participant) -> None:
    server = yarpy.RpcServer("/server", lambda message: [1])
    server.listen_to(f"ros2://gone~{ADD}")
    with yarpy.RpcClient("ros2://gone", name="/client") as client:
        assert client.ask([1, 2]).value == 1  # type: ignore[union-attr]
        server.close()
        wait_until(lambda: not part.graph.endpoints("/gone", "SS"))
        answer = client.ask([1, 2])
        assert answer is not None
        assert "nobody serves /gone" in answer.as_(yarpy.Bottle).to_text()


def test_what_does_not_fit_is_counted_and_named(
    part: Participant, caplog: pytest.LogCaptureFixture
) -> None:
    with yarpy.Port("/out") as out:
        out.connect("ros2://text~std_msgs/msg/String")
        with caplog.at_level(logging.WARNING, logger="yarpy"):
            out.write(5)
            out.write(5)
        assert caplog.text.count("std_msgs/String.data: expected a string, got 5") == 1


def test_another_type_is_named(part: Participant, caplog: pytest.LogCaptureFixture) -> None:
    with yarpy.Port("/out") as out, yarpy.Port("/in") as reader:
        with caplog.at_level(logging.WARNING, logger="yarpy"):
            reader.listen_to("ros2://mixed~std_msgs/msg/String")
            out.connect("ros2://mixed~std_msgs/msg/Int32")
            wait_until(lambda: caplog.text.count("do not hear each other at /mixed") == 2)
        assert "std_msgs/msg/String (RIHS01_df668c" in caplog.text
        assert "std_msgs/msg/Int32 (RIHS01_" in caplog.text


def test_everything_is_taken_back(part: Participant) -> None:
    with yarpy.Port("/out") as out, yarpy.RpcServer("/server", lambda message: [1]) as server:
        out.connect("ros2://text~std_msgs/msg/String")
        server.listen_to(f"ros2://add~{ADD}")
        wait_until(lambda: len(part.graph.tokens) == 4)
    wait_until(lambda: part.graph.tokens == [])


# -- bad input ------------------------------------------------------------------------------------


def test_messages_that_are_none(part: Participant, caplog: pytest.LogCaptureFixture) -> None:
    key = str(key_of(0, "/bad", String, False))
    good = b"".join(String(data="good").to_ros())
    attached = attachment(1, 1, bytes(16))
    with yarpy.BufferedPort("/in", strict=True) as reader, share() as shared:
        reader.listen_to("ros2://bad~std_msgs/msg/String")
        with caplog.at_level(logging.WARNING, logger="yarpy"):
            shared.session.put(key, good, attachment=b"old" * 30)
            shared.session.put(key, b"\xff" * 20, attachment=attached)
            shared.session.put(key, b"", attachment=attached)
            shared.session.put(key, good)  # without: a plain program of Zenoh
            for _ in range(2):
                with pytest.raises(yarpy.DecodeError):
                    _ = reader.read(timeout=HANG).value
            assert reader.read(timeout=HANG).value == "good"
        assert "older than 0.1.2" in caplog.text
        assert reader.stats.inputs[0].drops == 1


def test_lost_messages_are_counted(part: Participant) -> None:
    key = str(key_of(0, "/gaps", String, False))
    body = b"".join(String(data="x").to_ros())
    with yarpy.BufferedPort("/in", strict=True) as reader, share() as shared:
        reader.listen_to("ros2://gaps~std_msgs/msg/String")
        for number in (3, 4, 9):
            shared.session.put(key, body, attachment=attachment(number, 1, bytes(16)))
        for _ in range(3):
            reader.read(timeout=HANG)
        assert reader.stats.inputs[0].drops == 4


def test_the_first_message_says_the_type_and_is_heard(
    part: Participant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "SOON", HANG)  # on a busy computer, too
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        reader.listen_to("ros2://first")
        out.connect("ros2://first")
        out.write("one")
        out.write("two")
        assert [reader.read(timeout=HANG).value for _ in range(2)] == ["one", "two"]


def test_what_comes_while_a_subscriber_joins_is_read(
    part: Participant, monkeypatch: pytest.MonkeyPatch
) -> None:
    join = Subscriber.join
    heard: list[object] = []

    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:

        def slowly(endpoint: Subscriber, key: Key, kind: Any) -> None:
            join(endpoint, key, kind)
            body = b"".join(kind(data="early").to_ros())
            with share() as shared:
                shared.session.put(str(key), body, attachment=attachment(1, 1, bytes(16)))
            heard.append(reader.read(timeout=HANG).value)

        monkeypatch.setattr(Subscriber, "join", slowly)
        reader.listen_to("ros2://early")  # of no type, until somebody publishes
        out.connect("ros2://early~std_msgs/msg/String")
        wait_until(lambda: heard == ["early"])


def test_questions_that_are_none(part: Participant) -> None:
    service = ros2.load(ADD)
    key: Key = key_of(0, "/ask", service, False)
    attached = attachment(1, 1, bytes(16))

    def ask(payload: bytes, attachment: bytes | None) -> bytes:
        with share() as shared:
            replies = shared.session.get(
                str(key), payload=payload, attachment=attachment, target=zenoh.QueryTarget.ALL
            )
            found = list(replies)
        assert len(found) == 1
        good, bad = found[0].ok, found[0].err
        return bytes(good.payload) if good is not None else bytes(bad.payload)  # type: ignore[union-attr]

    with yarpy.RpcServer("/server", lambda message: [7]) as server:
        server.listen_to(f"ros2://ask~{ADD}")
        assert b"expected" in ask(b"", None)
        assert b"no plain CDR" in ask(b"\xff" * 30, attached)
        assert b"goes on beyond" in ask(b"\0\1\0\0", attached)
        good = b"".join(service.Request(a=1, b=2).to_ros())
        assert service.Response.from_ros(ask(good, attached)).sum == 7


def test_a_server_that_dies_in_the_middle(part: Participant) -> None:
    """Its session ends while it should answer: the client is told, at once."""
    key = key_of(0, "/dies", ros2.load(ADD), False)
    asked = threading.Event()
    held: list[object] = []

    def hold(query: object) -> None:
        held.append(query)
        asked.set()

    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", f'["tcp/{os.environ["YARPY_ZENOH"]}"]')
    session = zenoh.open(config)
    hear = zenoh.handlers.Callback(hold, indirect=False)
    session.declare_queryable(str(key), hear, complete=True)
    seen = part.session.declare_querier(str(key), target=zenoh.QueryTarget.ALL_COMPLETE)
    wait_until(lambda: seen.matching_status.matching)  # it has no token that tells of it
    with yarpy.RpcClient(f"ros2://dies~{ADD}", name="/client") as client:
        found: list[yarpy.Message | None] = []
        asks = threading.Thread(target=lambda: found.append(client.ask([1, 2])))
        asks.start()
        assert asked.wait(HANG)
        session.close()  # type: ignore[no-untyped-call]
        asks.join(HANG)
        assert found
        assert found[0] is not None
        assert "fail" in found[0].as_(yarpy.Bottle).to_text()


# -- an independent implementation ----------------------------------------------------------------


def test_topics_of_an_independent_node(router: int, part: Participant, tmp_path: Path) -> None:
    with (
        Peer(router, tmp_path, "hear", "/chatter") as hears,
        Peer(router, tmp_path, "say", "/news") as says,
        yarpy.Port("/robot/voice:o") as out,
        yarpy.BufferedPort("/in", strict=True) as reader,
    ):
        hears.ready(), says.ready()
        graph = part.graph
        wait_until(lambda: graph.endpoints("/chatter", "MS") and graph.endpoints("/news", "MP"))
        out.connect("ros2://chatter")  # the graph says which type it is
        reader.listen_to("ros2://news")
        wait_until(lambda: out.write(yarpy.Bottle(["grüße"])) and "grüße" in hears.said)
        assert hears.said[1] == "grüße"
        # It may hear of us later than we of it.
        wait_until(lambda: says.write_line("hello from there") or reader.waiting)
        assert reader.read(timeout=HANG).value == "hello from there"
        with Peer(router, tmp_path, "list") as lists:
            wait_until(lambda: lists.said)
            (found,) = lists.said
        assert ["/chatter", ["std_msgs/msg/String"]] in found  # type: ignore[operator]
        hears.kill()
        wait_until(
            lambda: not part.graph.endpoints("/chatter", "MS"),
            HANG,
            "its tokens go with it",
        )


def test_a_late_subscriber_of_an_independent_node(
    router: int, part: Participant, tmp_path: Path
) -> None:
    with yarpy.Port("/out") as out:
        out.connect("ros2+qos.latched://kept~std_msgs/msg/String")
        out.write("before")
        out.write("just before")
        with Peer(router, tmp_path, "hear", "/kept", "latched=1") as hears:
            hears.ready()
            wait_until(lambda: part.graph.endpoints("/kept", "MS"))
            out.write("after")
            wait_until(lambda: "after" in hears.said)
            assert [text for text in hears.said if text != "ready"] == ["just before", "after"]


QOS = {  # reliability, durability
    f"{reliability[0]}, {durability[0]}": f"{reliability[1]}:{durability[1]}:,5:,:,:,,"
    for reliability in (("reliable", ""), ("best_effort", "2"))
    for durability in (("volatile", ""), ("transient_local", "1"))
}


@pytest.mark.parametrize("order", ["yarpy first", "yarpy last"])
@pytest.mark.parametrize("qos", QOS)
def test_the_quality_of_service_of_an_independent_node(
    router: int, part: Participant, tmp_path: Path, qos: str, order: str
) -> None:
    """Over Zenoh all hear each other; with a type in the target, too."""
    up, down = (
        f"/up_{order[6:]}_{list(QOS).index(qos)}",
        f"/down_{order[6:]}_{list(QOS).index(qos)}",
    )

    def join() -> None:
        out.connect(f"ros2:/{up}~std_msgs/msg/String")
        reader.listen_to(f"ros2:/{down}~std_msgs/msg/String")

    with contextlib.ExitStack() as stack:
        out = stack.enter_context(yarpy.Port("/out"))
        reader = stack.enter_context(yarpy.BufferedPort("/in", strict=True))
        if order == "yarpy first":
            join()
        words = ("hear", up, f"say={down}", f"qos={QOS[qos]}")
        peer = stack.enter_context(Peer(router, tmp_path, *words))
        peer.ready()
        wait_until(lambda: part.graph.endpoints(up, "MS") and part.graph.endpoints(down, "MP"))
        if order == "yarpy last":
            join()
        # It may hear of us later than we of it.
        wait_until(lambda: peer.write_line("hello from there") or reader.waiting)
        assert reader.read(timeout=HANG).value == "hello from there"
        wait_until(lambda: out.write("hello") and len(peer.said) > 1)
        assert peer.said[1] == "hello"
        wait_until(
            lambda: (
                [one.qos.latched for one in part.graph.endpoints(down, "MS")]
                == ["transient" in qos]
            )
        )


def test_services_of_an_independent_node(router: int, part: Participant, tmp_path: Path) -> None:
    with (
        Peer(router, tmp_path, "serve", "/add") as serves,
        Peer(router, tmp_path, "call", "/times") as calls,
        yarpy.RpcServer("/server", lambda message: [message.ros.a * message.ros.b]) as server,  # type: ignore[attr-defined]
    ):
        server.listen_to(f"ros2://times~{ADD}")
        serves.ready(), calls.ready()
        wait_until(lambda: part.graph.endpoints("/add", "SS"))
        with yarpy.RpcClient("ros2://add", name="/client") as client:
            assert client.ask([5, 37]).value == 42  # type: ignore[union-attr]
        calls.write_line("6 7")
        wait_until(lambda: calls.said[1:] == [42])


def test_a_wrong_hash_of_an_independent_node(
    router: int, part: Participant, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with (
        Peer(router, tmp_path, "say", "/odd", f"hash=RIHS01_{'0' * 64}") as says,
        yarpy.BufferedPort("/in") as reader,
    ):
        says.ready()
        with caplog.at_level(logging.WARNING, logger="yarpy"):
            reader.listen_to("ros2://odd~std_msgs/msg/String")
            wait_until(lambda: "do not hear each other" in caplog.text)
        assert f"std_msgs/msg/String (RIHS01_{'0' * 64}) there" in caplog.text
        assert "the node /sdk_say" in caplog.text
