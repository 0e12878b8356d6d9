"""Zenoh, MQTT and WebSocket: what our side sends and takes, seen by programs without Wrapyfi.

Rules: expected bytes are written out as Wrapyfi sends them. Each middleware has a server of the
test's own.
"""

from __future__ import annotations

import json
import logging
import threading
import time
import types
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.broker import Broker
from support.paho_client import end
from support.port import free_block, free_port
from support.wait import HANG, wait_until

import yarpy

pytest.importorskip("zmq")

from wrapyfi.connect.wrapper import MiddlewareCommunicator, _records
from wrapyfi.middlewares._arrivals import Arrivals
from wrapyfi.middlewares._side import _Side

register = MiddlewareCommunicator.register
IMAGE = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)
SAMPLES = np.array([0.5, -0.5, 1.0, 0.0], np.float32)
MODES = ("publish", "listen", "request", "reply")
NAMES = ("zenoh", pytest.param("mqtt", marks=pytest.mark.peer("mosquitto")), "websocket")


class Pair(MiddlewareCommunicator):
    """One method for each type."""

    @register("NativeObject", "$mware", "Pair", "/pair/native", should_wait="$wait")
    def native(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("Image", "$mware", "Pair", "/pair/image", width=3, height=2, should_wait="$wait")
    def image(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("Image", "$mware", "Pair", "/pair/jpg", jpg=True, should_wait="$wait")
    def jpg(self, obj=None, mware="", wait=True):
        return (obj,)

    @register("AudioChunk", "$mware", "Pair", "/pair/sound", rate=8000, should_wait="$wait")
    def sound(self, obj=None, mware="", wait=True):
        return (obj,)


class Peer:
    """A program that knows the middleware alone: `seen` has what came, by topic."""

    def __init__(self) -> None:
        self.seen: dict[str, Any] = {}
        self.send: Callable[[str, Any], object] = lambda topic, data: None


@pytest.fixture(params=NAMES)
def mware(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def peer(mware: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Peer]:
    monkeypatch.setenv("WRAPYFI_TIMEOUT", str(HANG))
    found = Peer()
    with ExitStack() as stack:
        _STARTS[mware](found, stack, monkeypatch, tmp_path)
        yield found
        MiddlewareCommunicator.close_all_instances()


def _start_zenoh(peer: Peer, stack: ExitStack, monkeypatch: Any, folder: Path) -> None:
    zenoh = pytest.importorskip("zenoh")
    from yarpy.peers.zenoh.router import open_router
    from yarpy.peers.zenoh.transport import close

    port = free_port()
    stack.callback(close, open_router([f"tcp/127.0.0.1:{port}"]))
    monkeypatch.setenv("WRAPYFI_ZENOH_PORT", str(port))
    monkeypatch.setenv("WRAPYFI_ZENOH_MODE", "client")
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([f"tcp/127.0.0.1:{port}"]))
    session = stack.enter_context(zenoh.open(config))
    session.declare_subscriber(
        "pair/*", lambda one: peer.seen.update({f"/{one.key_expr}": one.payload.to_bytes()})
    )
    peer.send = lambda topic, data: session.put(topic.strip("/"), data)


def _start_mqtt(peer: Peer, stack: ExitStack, monkeypatch: Any, folder: Path) -> None:
    paho = pytest.importorskip("paho.mqtt.client")
    broker = Broker(folder)
    stack.callback(broker.stop)
    monkeypatch.setenv("WRAPYFI_MQTT_BROKER_ADDRESS", "127.0.0.1")
    monkeypatch.setenv("WRAPYFI_MQTT_BROKER_PORT", str(broker.port))
    client = paho.Client(paho.CallbackAPIVersion.VERSION2)
    client.on_message = lambda _, __, one: peer.seen.update({one.topic: one.payload})
    client.on_connect = lambda *_: client.subscribe("/pair/#")
    ready: list[bool] = []
    client.on_subscribe = lambda *_: ready.append(True)
    client.connect("127.0.0.1", broker.port)
    client.loop_start()
    stack.callback(end, client)
    wait_until(lambda: bool(ready))
    peer.send = client.publish


def _start_websocket(peer: Peer, stack: ExitStack, monkeypatch: Any, folder: Path) -> None:
    pytest.importorskip("socketio")
    from support.socketio_server import SocketIoServer

    from wrapyfi.middlewares._socketio import Client

    port = free_port()
    stack.enter_context(SocketIoServer(port))
    monkeypatch.setenv("WRAPYFI_WEBSOCKET_SOCKET_PORT", str(port))
    client = Client()
    client.on("*", lambda event, data: peer.seen.update({event: data}))
    client.connect(f"http://127.0.0.1:{port}", wait_timeout=HANG)
    stack.callback(client.disconnect)
    peer.send = client.emit


_STARTS: dict[str, Callable[..., None]] = {
    "zenoh": _start_zenoh,
    "mqtt": _start_mqtt,
    "websocket": _start_websocket,
}


def split(mware: str, data: Any) -> tuple[dict[str, Any], bytes]:
    """Header and body of what was sent."""
    if mware == "websocket":
        from base64 import b64decode

        header, body = data
        return header, b64decode(body) if isinstance(body, str) else body
    if mware == "mqtt":
        length = int.from_bytes(data[:4], "big")
        return json.loads(data[4 : 4 + length]), data[4 + length :]
    line, _, body = data.partition(b"\n")
    return json.loads(line), body


def joined(mware: str, header: dict[str, Any], body: bytes, sound: bool = False) -> Any:
    """What Wrapyfi would send."""
    if mware == "websocket":
        from base64 import b64encode

        return [header, body if sound else b64encode(body).decode()]
    text = json.dumps(header).encode()
    if mware == "mqtt":
        return len(text).to_bytes(4, "big") + text + body
    return text + b"\n" + body


def sent(peer: Peer, topic: str, act: Callable[[], object]) -> Any:
    """What the other program got of it."""

    def there() -> bool:
        act()
        time.sleep(0.02)
        return topic in peer.seen

    wait_until(there)
    return peer.seen[topic]


def test_what_is_sent_has_the_forms_of_wrapyfi(mware: str, peer: Peer) -> None:
    here = Pair()
    for method in (here.native, here.image, here.jpg, here.sound):
        here.activate_communication(method.__name__, "publish")
    value = {"i": 0, "t": (1, 2)}
    found = sent(peer, "/pair/native", lambda: here.native(value, mware=mware))
    text = b'{"i": 0, "t": {"__wrapyfi__": ["tuple", [1, 2]]}}'
    assert found == (text.decode() if mware == "websocket" else text)
    header, body = split(mware, sent(peer, "/pair/image", lambda: here.image(IMAGE, mware=mware)))
    assert isinstance(header.pop("timestamp"), float) and body == IMAGE.tobytes()
    assert header == {"shape": [2, 3, 3], "dtype": "uint8"}
    header, body = split(mware, sent(peer, "/pair/jpg", lambda: here.jpg(IMAGE, mware=mware)))
    assert list(header) == ["timestamp"] and body[:3] == b"\xff\xd8\xff"
    chunk = (SAMPLES, 8000)
    header, body = split(mware, sent(peer, "/pair/sound", lambda: here.sound(chunk, mware=mware)))
    assert isinstance(header.pop("timestamp"), float) and body == SAMPLES.tobytes()
    assert header == {"shape": [4], "dtype": "float32", "rate": 8000}


def heard(peer: Peer, topic: str, data: Any, act: Callable[[], Any]) -> Any:
    """What a listener got that does not wait."""
    found: list[Any] = []

    def there() -> bool:
        peer.send(topic, data)
        time.sleep(0.02)
        found[:] = act()
        value = found[0]
        return value is not None and (not isinstance(value, tuple) or value[0] is not None)

    wait_until(there)
    return found[0]


def test_messages_are_handled_one_after_the_other() -> None:
    """The library's own client handles each in a thread of its own, where bytes may come first."""
    pytest.importorskip("socketio")
    from wrapyfi.middlewares._socketio import Client

    client, seen = Client(), list[int]()
    client.eio.on("message", lambda data: seen.append(threading.get_ident()))
    for _ in range(3):
        client.eio._trigger_event("message", "x", run_async=True)
    assert seen == [threading.get_ident()] * 3


def test_what_wrapyfi_sends_is_taken(mware: str, peer: Peer) -> None:
    there = Pair()
    for name in ("native", "image", "jpg", "sound"):
        there.activate_communication(name, "listen")
    assert there.native(mware=mware, wait=False) == [None]
    assert there.sound(mware=mware, wait=False) == [(None, 8000)]
    text = '{"t": {"__wrapyfi__": ["tuple", [1, 2]]}}'
    found = heard(peer, "/pair/native", text, lambda: there.native(mware=mware, wait=False))
    assert found == {"t": (1, 2)}
    head = {"timestamp": 1.5, "shape": [2, 3, 3], "dtype": "uint8"}
    data = joined(mware, head, IMAGE.tobytes())
    found = heard(peer, "/pair/image", data, lambda: there.image(mware=mware, wait=False))
    assert found.tolist() == IMAGE.tolist()
    found += 1  # it is the listener's own
    from wrapyfi.utils.image_encoders import JpegEncoder

    plain = np.full((24, 32, 3), (200, 10, 20), np.uint8)
    data = joined(mware, {"timestamp": 1.5}, JpegEncoder().encode_jpg_image(plain))
    found = heard(peer, "/pair/jpg", data, lambda: there.jpg(mware=mware, wait=False))
    assert np.abs(found.astype(int) - plain).max() < 9
    head = {"shape": [2, 2], "dtype": "float32", "rate": 8000, "timestamp": 1.5}
    data = joined(mware, head, SAMPLES.tobytes(), sound=True)
    samples, rate = heard(peer, "/pair/sound", data, lambda: there.sound(mware=mware, wait=False))
    assert samples.tolist() == SAMPLES.reshape(2, 2).tolist() and rate == 8000


def test_what_cannot_be_read_is_told_and_the_next_one_counts(
    mware: str, peer: Peer, caplog: pytest.LogCaptureFixture
) -> None:
    there = Pair()
    there.activate_communication("native", "listen")
    there.activate_communication("image", "listen")
    huge = joined(mware, {"timestamp": 1, "shape": [1 << 40, 9], "dtype": "uint8"}, b"abc")
    odd = joined(mware, {"timestamp": 1, "shape": [3], "dtype": "object"}, b"abc")
    bad = {
        "/pair/native": ["{", "[" * 5000, '{"__wrapyfi__": ["numpy.ndarray", "AAAA"]}', "\xff"],
        "/pair/image": [huge, odd, "7", joined(mware, {"shape": [3]}, b"abc")],
    }
    head = {"timestamp": 1, "shape": [2, 3, 3], "dtype": "uint8"}
    good = {"/pair/native": '"end"', "/pair/image": joined(mware, head, IMAGE.tobytes())}
    for topic, method in (("/pair/native", there.native), ("/pair/image", there.image)):

        def listen(method: Any = method) -> Any:
            return method(mware=mware, wait=False)

        heard(peer, topic, good[topic], listen)  # it has subscribed
        wait_until(lambda listen=listen: listen()[0] is None)
        with caplog.at_level(logging.ERROR):
            for one in bad[topic]:
                peer.send(topic, one)
            found = heard(peer, topic, good[topic], listen)

        def told(topic: str = topic, listen: Any = listen) -> bool:
            listen()
            return caplog.text.count(f"{topic}: what came cannot be read") == len(bad[topic])

        wait_until(told)
        assert found == "end" if topic == "/pair/native" else found.shape == (2, 3, 3)


def test_both_sides_and_two_listeners(mware: str, peer: Peer) -> None:
    """Closing one closes one; a second listener of a topic is no less than the first."""
    here, there, third = Pair(), Pair(), Pair()
    here.activate_communication("native", "publish")
    for one in (there, third):
        one.activate_communication("native", "listen")

    def both(*listeners: Pair) -> bool:
        here.native(1, mware=mware)
        time.sleep(0.02)
        return all(one.native(mware=mware, wait=False) == [1] for one in listeners)

    wait_until(lambda: both(there, third))
    there.close()
    wait_until(lambda: both(third))


@pytest.mark.parametrize("mware", ["mqtt", "zenoh", "websocket"])
def test_nobody_there_is_an_error_and_no_hang(mware: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip({"mqtt": "yarpy", "zenoh": "zenoh", "websocket": "socketio"}[mware])
    monkeypatch.setenv("WRAPYFI_TIMEOUT", "0.5")
    monkeypatch.setenv("WRAPYFI_ZENOH_MODE", "client")
    for name in ("MQTT_BROKER", "ZENOH", "WEBSOCKET_SOCKET"):
        monkeypatch.setenv(f"WRAPYFI_{name}_PORT", str(free_port()))
    monkeypatch.setenv("WRAPYFI_MQTT_BROKER_ADDRESS", "127.0.0.1")
    one = Pair()
    one.activate_communication("native", "publish")
    with pytest.raises((yarpy.Timeout, yarpy.LinkClosed)):
        one.native(1, mware=mware)
    one.close()


def test_a_public_broker_is_told(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    from wrapyfi.middlewares.mqtt import _target

    monkeypatch.delenv("WRAPYFI_MQTT_BROKER_ADDRESS", raising=False)
    known = {"username": "me", "password": "a+b/c"}
    with caplog.at_level(logging.WARNING):
        found = _target({"mqtt_kwargs": known}, "/t", "sub")
    assert found == "mqtt+sub+user.me+password.a%2Bb%2Fc://broker.emqx.io:1883//t"
    assert "everybody can read it" in caplog.text
    assert _target({"broker_address": "here"}, "t") == "mqtt://here:1883/t"


@pytest.mark.usefixtures("names")
@pytest.mark.parametrize(
    ("mware", "mode"),
    [
        *[(mware, mode) for mware in ("yarp", "zeromq") for mode in MODES],
        *[(mware, mode) for mware in ("mqtt", "websocket") for mode in MODES[:2]],
    ],
)
def test_closing_ends_waiting(mware: str, mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """For nobody, who never comes, without a timeout."""
    pytest.importorskip("socketio")
    monkeypatch.delenv("WRAPYFI_TIMEOUT", raising=False)
    number = free_block(4)
    for name in ("MQTT_BROKER", "WEBSOCKET_SOCKET", "ZEROMQ_SOCKET_PUB", "ZEROMQ_SOCKET_SUB"):
        number += 1
        monkeypatch.setenv(f"WRAPYFI_{name}_PORT", str(number))
    monkeypatch.setenv("WRAPYFI_MQTT_BROKER_ADDRESS", "127.0.0.1")
    # The brokers of one test keep what nobody has answered, also for the next one.
    monkeypatch.setenv("WRAPYFI_ZEROMQ_SOCKET_IP", f"127.{number % 250}.7.{MODES.index(mode) + 1}")
    one = Pair()
    one.activate_communication("native", mode)
    ended: list[Exception] = []

    def wait() -> None:
        try:
            one.native(1, mware=mware)
        except yarpy.YarpError as error:
            ended.append(error)

    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    wait_until(lambda: any(one.opened for record in _records for one in record.instances))
    one.close()  # perhaps while it opens what it waits for
    thread.join(HANG)
    assert not thread.is_alive() and ended


def test_what_is_closed_while_it_opens_stays_closed() -> None:
    """Also what it has opened by then."""
    side, made = _Side(), []

    def make(side: _Side) -> Any:
        side.close()
        made.append(types.SimpleNamespace(closed=0))
        made[-1].close = lambda: setattr(made[-1], "closed", 1)
        return made[-1]

    for _ in range(2):
        with pytest.raises(yarpy.PortClosed):
            side._open(make)
    assert [one.closed for one in made] == [1]


def test_what_is_not_taken_goes() -> None:
    for kind, kept in (("NativeObject", 100), ("Image", 10)):
        side = types.SimpleNamespace(in_topic="/t", options={}, kind=kind)
        arrivals = Arrivals(side)
        for number in range(300):
            arrivals.arrived(number)
        assert [arrivals.receive(0) for _ in range(kept)] == list(range(300 - kept, 300))
        with pytest.raises(yarpy.Timeout):
            arrivals.receive(0)
    side.options["queue_size"] = 2
    arrivals = Arrivals(side, 5)
    for number in range(3):
        arrivals.arrived(number)
    assert [arrivals.receive(0), arrivals.receive(0)] == [1, 2]
