"""Ports and the sockets of pyzmq (libzmq): each dials the other, in every pair of types."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.access import allow, write
from support.lasted import lasted
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.sig import jpeg
from yarpy.link.send import outbound

zmq = pytest.importorskip("zmq", reason="needs pyzmq (pip install pyzmq)")
from zmq.utils import z85  # noqa: E402
from zmq.utils.monitor import recv_monitor_message  # noqa: E402


class Sockets:
    """Sockets that wait for `HANG` at most, and are closed with the test."""

    def __init__(self, context: Any) -> None:
        self.context = context
        self.all: list[Any] = []

    def make(self, kind: int, **options: Any) -> Any:
        socket = self.context.socket(kind)
        self.all.append(socket)
        socket.linger = 0
        socket.rcvtimeo = socket.sndtimeo = int(1000 * HANG)
        for name, value in options.items():
            socket.setsockopt(getattr(zmq, name), value)
        return socket

    def connected(self, kind: int, port: Any, **options: Any) -> Any:
        """A socket that has dialled a port."""
        socket = self.make(kind, **options)
        socket.connect(f"tcp://127.0.0.1:{port.contact.port}")
        return socket

    def bound(self, kind: int, **options: Any) -> tuple[Any, str]:
        """A socket that a port can dial, and where."""
        socket = self.make(kind, **options)
        number = socket.bind_to_random_port("tcp://127.0.0.1")
        return socket, f"127.0.0.1:{number}"

    def is_turned_away(self, kind: int, port: Any, **options: Any) -> bool:
        """Whether a port hangs up on such a socket before it is connected."""
        socket = self.make(kind, **options)
        failed = zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL | zmq.EVENT_DISCONNECTED
        events = socket.get_monitor_socket(failed | zmq.EVENT_HANDSHAKE_SUCCEEDED)
        socket.connect(f"tcp://127.0.0.1:{port.contact.port}")
        event = recv_monitor_message(events) if events.poll(1000 * HANG) else {"event": 0}
        socket.disable_monitor()
        socket.close()
        events.close()
        return bool(event["event"] & failed)

    def subscriber(self, port: Any, *topics: bytes, **options: Any) -> Any:
        """A SUB of a port, once the port knows what it wants."""
        before = len(port.outputs)
        socket = self.connected(zmq.SUB, port, **options)
        for topic in topics:
            socket.subscribe(topic)
        wait_until(lambda: len(port.outputs) > before)
        link = port._hub.outputs.links[-1]
        wait_until(lambda: len(link.carrier._wanted) == len(topics))
        return socket


@pytest.fixture
def sockets() -> Iterator[Sockets]:
    context = zmq.Context()
    made = Sockets(context)
    yield made
    for socket in made.all:
        socket.close(linger=0)
    context.destroy(linger=0)


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/out", names=names) as port:
        yield port


# --------------------------------------------------------------------------- sockets that dial us


def test_a_sub_gets_what_a_port_writes(out: yarpy.Port, sockets: Sockets) -> None:
    every, some, other = (sockets.subscriber(out, topic) for topic in (b"", b"/ou", b"/elsewhere"))
    for number in range(100):
        out.write([number, "text"])
    for socket in (every, some):
        found = [socket.recv_multipart() for _ in range(100)]
        assert found == [[b"/out", b'[%d, "text"]' % number] for number in range(100)]
    assert not other.poll(50)
    wait_until(lambda: [link.stats.messages for link in out.outputs] == [100, 100, 0])
    every.unsubscribe(b"")
    link = out._hub.outputs.links[0]
    wait_until(lambda: not link.carrier._wanted)
    out.write("unheard")
    assert some.recv_multipart() == [b"/out", b'"unheard"']
    assert not every.poll(50)


def test_a_sub_may_want_the_spelling_of_yarp(out: yarpy.Port, sockets: Sockets) -> None:
    raw = sockets.subscriber(out, b"raw:")
    value = yarpy.Bottle([1, yarpy.Vocab("set"), b"\0"])
    out.write(value)
    topic, data = raw.recv_multipart()
    assert topic == b"raw:/out"
    assert yarpy.Bottle.from_bytes(data) == value


def test_a_sub_gets_pictures(out: yarpy.Port, sockets: Sockets) -> None:
    viewer = sockets.subscriber(out, b"")
    out.write(np.full((48, 64, 3), 100, "u1"))
    _, data = viewer.recv_multipart()
    picture = yarpy.Image.from_wire(jpeg.decode(data))
    assert (picture.width, picture.height) == (64, 48)


def test_listening_to_a_socket_subscribes(reader: yarpy.BufferedPort, sockets: Sockets) -> None:
    pub, at = sockets.bound(zmq.XPUB)
    reader.listen_to(f"zmq+sub.arm://{at}")
    assert pub.recv() == b"\1arm"
    pub.send_multipart([b"arm", b"[1]"])
    assert reader.read(timeout=HANG).value == [1]
    with pytest.raises(yarpy.LocalProtocolError, match=r"such as zmq\+sub.TOPIC"):
        reader.listen_to(f"zmq+push://{at}")


def test_a_pull_gets_every_message_in_order(out: yarpy.Port, sockets: Sockets) -> None:
    count = 10_000
    sink = sockets.connected(zmq.PULL, out)
    assert out.wait_for_outputs(timeout=HANG)
    writer = threading.Thread(target=lambda: [out.write(number) for number in range(count)])
    writer.start()
    assert [int(sink.recv()) for _ in range(count)] == list(range(count))
    writer.join()


def test_push_and_pub_write_into_a_port(reader: yarpy.BufferedPort, sockets: Sockets) -> None:
    push = sockets.connected(zmq.PUSH, reader)
    push.send_json({"speed": 1.5, "on": True})
    assert reader.read(timeout=HANG).as_(dict) == {"speed": 1.5, "on": True}
    for payload, value in (("12", 12), ("go ahead", "go ahead"), ("[1, 2]", yarpy.Bottle([1, 2]))):
        push.send_string(payload)
        assert reader.read(timeout=HANG).value == value
    push.send_multipart([b"1", b"x"])
    assert reader.read(timeout=HANG).value == yarpy.Bottle([1, "x"])
    big = np.random.default_rng(1).bytes(3_000_000)
    push.send(big)
    assert reader.read(timeout=HANG).as_(bytes) == big
    pub = sockets.connected(zmq.XPUB, reader)
    assert pub.recv() == b"\1"  # we want everything
    pub.send_multipart([b"topic", b"[7]"])
    message = reader.read(timeout=HANG)
    assert message.value == yarpy.Bottle([7])
    assert message.source == "zmq"


def test_req_and_dealer_ask(names: yarpy.LocalNames, sockets: Sockets) -> None:
    with yarpy.RpcServer("/adder", lambda message: sum(message.value), names=names) as server:
        req = sockets.connected(zmq.REQ, server)
        for number in range(20):
            req.send_json([number, 1])
            assert req.recv_json() == number + 1
        dealer = sockets.connected(zmq.DEALER, server)
        for number in range(20):  # all at once: each is answered, in order
            dealer.send_multipart([b"", b"[%d, 2]" % number])
        for number in range(20):
            assert dealer.recv_multipart() == [b"", b"%d" % (number + 2)]


def test_a_worker_that_dials_us_is_asked(names: yarpy.LocalNames, sockets: Sockets) -> None:
    with yarpy.RpcClient(name="/asker", names=names) as client:
        worker = sockets.connected(zmq.REP, client)
        wait_until(lambda: client.outputs)
        threading.Thread(target=lambda: worker.send(b"[" + worker.recv() + b"]")).start()
        assert client.ask("hm", timeout=HANG).value == yarpy.Bottle(["hm"])


# ------------------------------------------------------------------------------ sockets we dial


def test_a_port_dials_sub_and_pull(out: yarpy.Port, sockets: Sockets) -> None:
    sub, at = sockets.bound(zmq.SUB)
    sub.subscribe(b"cam")
    out.connect(f"zmq+pub.camera://{at}")
    # A bound SUB says what it wants only when its program looks.
    wait_until(lambda: sub.poll(1) or out._hub.outputs.links[0].carrier._wanted)
    pull, at = sockets.bound(zmq.PULL)
    out.connect(f"zmq+push://{at}")
    out.write([1])
    assert sub.recv_multipart() == [b"camera", b"[1]"]
    assert pull.recv_json() == [1]
    out.connect(f"zmq+push://{at}")  # in place of the one that there is
    out.write([2])
    assert pull.recv_json() == [2]
    assert not pull.poll(50)


def test_a_port_dials_pub_and_push(reader: yarpy.BufferedPort, sockets: Sockets) -> None:
    pub, at = sockets.bound(zmq.XPUB)
    reader.connect(f"zmq+sub.cam://{at}")
    assert pub.recv() == b"\1cam"
    pub.send_multipart([b"dog", b"1"])
    pub.send_multipart([b"camera", b"2"])
    assert reader.read(timeout=HANG).value == 2
    push, at = sockets.bound(zmq.PUSH)
    reader.connect(f"zmq+pull://{at}")
    push.send(b"3")
    assert reader.read(timeout=HANG).value == 3


def test_a_port_dials_rep_and_req(names: yarpy.LocalNames, sockets: Sockets) -> None:
    rep, at = sockets.bound(zmq.REP)
    with yarpy.RpcClient(name="/asker", names=names) as client:
        client.connect(f"zmq+req://{at}")

        def serve() -> None:
            for _ in range(3):
                rep.send_json(["so", rep.recv_json()])

        thread = threading.Thread(target=serve)
        thread.start()
        for number in range(3):
            answer = client.ask([number], timeout=HANG)
            assert answer.value == yarpy.Bottle(["so", yarpy.Bottle([number])])
        thread.join()
    req, at = sockets.bound(zmq.REQ)
    with yarpy.RpcServer("/double", lambda message: [2 * message.value], names=names) as server:
        server.connect(f"zmq+rep://{at}")
        req.send(b"21")
        assert req.recv_json() == [42]


def test_a_rep_that_dies_in_the_middle_of_a_call_ends_it(
    names: yarpy.LocalNames, sockets: Sockets
) -> None:
    rep, at = sockets.bound(zmq.REP)
    with yarpy.RpcClient(name="/asker", names=names) as client:
        client.connect(f"zmq+req://{at}")
        thread = threading.Thread(target=lambda: (rep.recv(), rep.close()))
        thread.start()
        with pytest.raises(yarpy.LinkClosed):
            client.ask("are you there", timeout=HANG)
        thread.join()


def test_wrong_targets_are_explained(out: yarpy.Port, sockets: Sockets) -> None:
    _, at = sockets.bound(zmq.REP)
    for target, why in (
        (f"zmq+pub://{at}", r"the peer is REP.*take zmq\+req"),
        (f"zmq://{at}", r"zmq\+push"),
        ("zmq+push://127.0.0.1:1", "nobody answers"),
    ):
        with pytest.raises(yarpy.YarpError, match=why):
            out.connect(target)
    assert not out.outputs


def test_what_does_not_go_over_tcp_is_refused(
    out: yarpy.Port, sockets: Sockets, tmp_path: Path
) -> None:
    bound = sockets.make(zmq.SUB)
    bound.bind(place := f"ipc://{tmp_path}/s")
    for target in (place, "inproc://s", "pgm://eth0;239.1.1.1:5555"):
        with pytest.raises(yarpy.UnknownPlugin, match=r"no carrier .*, zmq"):
            out.connect(target)
    for target in (f"zmq+pub://{place}", "zmq+pub://inproc://s"):
        with pytest.raises(yarpy.UnknownName, match="HOST:NUMBER, over TCP; there is no ipc"):
            out.connect(target)
    assert not out.outputs


# --------------------------------------------------------------------------------- what goes wrong


def test_heartbeats_keep_a_silent_subscriber(out: yarpy.Port, sockets: Sockets) -> None:
    options = {"HEARTBEAT_IVL": 100, "HEARTBEAT_TIMEOUT": int(1000 * HANG)}
    socket = sockets.make(zmq.SUB, **options)
    events = socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    socket.subscribe(b"")
    socket.connect(f"tcp://127.0.0.1:{out.contact.port}")
    assert out.wait_for_outputs(timeout=HANG)
    link = out._hub.outputs.links[0]
    start = link.driver.bytes_in
    wait_until(lambda: link.driver.bytes_out > 200)  # a dozen PONGs
    assert link.driver.bytes_in > start
    assert not events.poll(0)
    assert len(out.outputs) == 1
    socket.disable_monitor()
    events.close()


def test_a_subscriber_that_takes_nothing_keeps_nobody_waiting(
    out: yarpy.Port, names: yarpy.LocalNames, sockets: Sockets
) -> None:
    slow = sockets.subscriber(out, b"", RCVHWM=1, RCVBUF=4096)
    with yarpy.BufferedPort("/near", strict=True, names=names) as near:
        out.connect("/near")
        started = time.monotonic()
        for number in range(60):
            out.write([number, bytes(200_000)])
        assert [near.read(timeout=HANG).value[0] for _ in range(60)] == list(range(60))
    link = next(link for link in out.outputs if link.carrier == "zmq+sub")
    stats = link.stats
    assert stats.drops == 0
    assert lasted(started) < HANG
    numbers = [yarpy.data.json.from_json(slow.recv_multipart()[1])[0] for _ in range(60)]
    assert numbers == list(range(60))


@pytest.mark.parametrize("size", [1000, 200_000])
def test_a_burst_waits_for_its_subscriber_as_with_zeromq(
    out: yarpy.Port, sockets: Sockets, size: int
) -> None:
    """200 messages, written at once, before anybody reads: 200 arrive, as from a PUB."""
    pub = sockets.make(zmq.PUB)
    theirs = sockets.make(zmq.SUB, RCVHWM=1)
    theirs.subscribe(b"")
    theirs.connect(f"tcp://127.0.0.1:{pub.bind_to_random_port('tcp://127.0.0.1')}")
    wait_until(lambda: pub.send(b"") or theirs.poll(10))
    ours = sockets.subscriber(out, b"", RCVHWM=1)
    body = bytes(size)
    for number in range(200):
        pub.send_multipart([b"burst", body, b"%d" % number])
        out.write([body])
    for socket in (theirs, ours):
        got = 0
        while got < 200:
            frames = socket.recv_multipart()
            got += frames[0] != b""  # of the PUB's first tries
            assert len(frames) == 1 or frames[1] == body
    assert out._hub.outputs.links[0].counter.drops == 0


def test_beyond_the_high_water_mark_the_newest_is_dropped(
    out: yarpy.Port, sockets: Sockets
) -> None:
    slow = sockets.subscriber(out, b"", RCVHWM=1, RCVBUF=4096)
    body = bytes(200_000)
    for number in range(500):  # more than the bytes that may wait
        out.write([f"{number:03d}", body])
    (link,) = out._hub.outputs.links
    dropped = link.counter.drops
    assert 0 < dropped < 400
    assert link.counter.replaced == 0
    first = yarpy.data.json.from_json(slow.recv_multipart()[1])[0]
    assert first == "000"


def test_a_pull_that_takes_nothing_is_cut_off_and_a_subscriber_misses_nothing(
    out: yarpy.Port, sockets: Sockets, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As with `send` of a PUSH `write` waits, but the SUB has the message by then."""
    monkeypatch.setattr(outbound, "STRANGERS", 0.5)
    slow = sockets.connected(zmq.PULL, out, RCVHWM=1, RCVBUF=4096)
    wait_until(lambda: len(out.outputs) == 1)
    near = sockets.subscriber(out, b"")
    body = bytes(200_000)
    for number in range(60):  # 12 MB: more than the buffers of the system hold
        out.write([f"{number:02d}", body])
        frames = near.recv_multipart()
        assert yarpy.data.json.from_json(frames[1])[0] == f"{number:02d}"
    assert [link.carrier for link in out.outputs] == ["zmq+sub"]
    assert out.stats.outputs[0].drops == 0
    assert yarpy.data.json.from_json(slow.recv())[0] == "00"


def test_who_writes_without_waiting_drops_what_a_pull_does_not_take(
    out: yarpy.Port, sockets: Sockets
) -> None:
    pull = sockets.connected(zmq.PULL, out, RCVHWM=1, RCVBUF=4096)
    wait_until(lambda: len(out.outputs) == 1)
    body = bytes(200_000)
    out.write(["00", body])
    for number in range(1, 60):
        out.write([f"{number:02d}", body], timeout=0)
    end = threading.Thread(target=out.write, args=(["60"],))  # which waits for its turn
    end.start()
    found = [""]
    while found[-1] != "60":
        found.append(yarpy.data.json.from_json(pull.recv())[0])
    end.join(HANG)
    drops = out.stats.outputs[0].drops
    assert drops and found[1] == "00" and found == sorted(found) and len(found) == 62 - drops


def test_a_pull_that_was_restarted_is_dialled_again(out: yarpy.Port, sockets: Sockets) -> None:
    pull, at = sockets.bound(zmq.PULL)
    out.connect(f"zmq+push://{at}")
    out.write([1])
    assert pull.recv_json() == [1]
    pull.close()
    wait_until(lambda: not out.outputs)
    again = sockets.make(zmq.PULL)
    again.bind(f"tcp://{at}")
    assert out.wait_for_outputs(timeout=HANG)
    out.write([2])
    assert again.recv_json() == [2]


def test_a_subscriber_finds_a_port_that_was_restarted(
    names: yarpy.LocalNames, sockets: Sockets
) -> None:
    number = free_port()
    with yarpy.Port("/out", tcp_port=number, names=names) as out:
        socket = sockets.subscriber(out, b"", RECONNECT_IVL=20)
    with yarpy.Port("/out", tcp_port=number, names=names) as out:
        assert out.wait_for_outputs(timeout=HANG)
        link = out._hub.outputs.links[0]
        # A SUB says again what it wants when its program looks.
        wait_until(lambda: socket.poll(1) or link.carrier._wanted)
        out.write("back")
        assert socket.recv_multipart() == [b"/out", b'"back"']


def test_a_socket_with_security_is_told_no(
    out: yarpy.Port,
    sockets: Sockets,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    if not zmq.has("curve"):
        pytest.skip("this libzmq has no CURVE")
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))  # where no curve.key is
    server, _ = zmq.curve_keypair()
    public, secret = zmq.curve_keypair()
    keys = {"CURVE_SERVERKEY": server, "CURVE_PUBLICKEY": public, "CURVE_SECRETKEY": secret}
    sockets.connected(zmq.SUB, out, **keys)
    wait_until(lambda: "the security mechanism CURVE" in caplog.text)
    assert not out.outputs


def test_a_port_logs_in_to_a_socket(sockets: Sockets, reader: yarpy.BufferedPort) -> None:
    with Doorkeeper(sockets.context, {b"me": b"a word"}):
        socket, where = sockets.bound(zmq.PUB, PLAIN_SERVER=1)
        for wrong in ("zmq+sub", "zmq+sub+user.me", "zmq+sub+user.me+password.other"):
            with pytest.raises(yarpy.LinkClosed if wrong == "zmq+sub" else yarpy.AccessRefused):
                reader.listen_to(f"{wrong}://{where}", timeout=HANG)
        reader.listen_to(f"zmq+sub+user.me+password.a word://{where}")
        wait_until(lambda: socket.send(b"hello") is None and reader.poll() is not None)


def test_a_port_dials_sockets_with_a_key(
    names: yarpy.LocalNames, sockets: Sockets, out: yarpy.Port, reader: yarpy.BufferedPort
) -> None:
    if not zmq.has("curve"):
        pytest.skip("this libzmq has no CURVE: pip install pyzmq brings one that has")
    public, secret = zmq.curve_keypair()
    own = {"CURVE_SERVER": 1, "CURVE_SECRETKEY": secret}
    key, other = (z85.decode(one).hex() for one in (public, zmq.curve_keypair()[0]))
    for kind, word in ((zmq.PUB, "sub"), (zmq.PUSH, "pull")):
        socket, where = sockets.bound(kind, **own)
        for wrong in (f"zmq+{word}", f"zmq+{word}+curve.{other}"):
            with pytest.raises(yarpy.LinkClosed):
                reader.listen_to(f"{wrong}://{where}", timeout=HANG)
        reader.listen_to(f"zmq+{word}+curve.{key}://{where}")
        text = word.encode()
        wait_until(lambda socket=socket, text=text: socket.send(text) or came(reader, text))
    for kind, word, size in ((zmq.PULL, "push", 1), (zmq.SUB, "pub", 2)):
        # Its own patience is as long as its interval, which a busy machine outlasts.
        beats = {"HEARTBEAT_IVL": 20, "HEARTBEAT_TIMEOUT": int(1000 * HANG)}
        socket, where = sockets.bound(kind, **beats, **own)
        if kind == zmq.SUB:
            socket.subscribe(b"")
        target = f"zmq+{word}+curve.{key}://{where}"
        out.connect(target)
        for number in range(3):
            wait_until(lambda one=number, socket=socket: (out.write([one]), socket.poll(10))[1])
            assert len(socket.recv_multipart()) == size
        out.write("x" * 100_000)
        while len(socket.recv_multipart()[-1]) < 100_000:
            pass
        out.disconnect(target)
    socket, where = sockets.bound(zmq.REQ, **own)
    with yarpy.RpcServer("/double", lambda message: [2 * message.value], names=names) as server:
        server.connect(f"zmq+rep+curve.{key}://{where}")
        socket.send(b"21")
        assert socket.recv_json() == [42]
    with yarpy.RpcClient(name="/asker", names=names) as client:
        socket, where = sockets.bound(zmq.REP, **own)
        client.connect(f"zmq+req+curve.{key}://{where}")
        answering = threading.Thread(target=lambda: socket.send_json([*socket.recv_json(), 3]))
        answering.start()
        assert list(client.ask([1, 2], timeout=HANG).value) == [1, 2, 3]
        answering.join(HANG)


def came(reader: yarpy.BufferedPort, text: bytes) -> bool:
    """Return whether the next message is this text; take it."""
    message = reader.poll()
    return message is not None and message.as_(bytes) == text


def test_a_socket_with_a_key_knows_its_ports(sockets: Sockets, reader: yarpy.BufferedPort) -> None:
    if not zmq.has("curve"):
        pytest.skip("this libzmq has no CURVE: pip install pyzmq brings one that has")
    public, secret = zmq.curve_keypair()
    ours, own = zmq.curve_keypair()
    key, password = (z85.decode(one).hex() for one in (public, own))
    with Doorkeeper(sockets.context, keys={z85.decode(ours)}):
        socket, where = sockets.bound(zmq.PUB, CURVE_SERVER=1, CURVE_SECRETKEY=secret)
        with pytest.raises(yarpy.LoginRefused, match=r"\+password.KEY"):
            reader.listen_to(f"zmq+sub+curve.{key}://{where}", timeout=HANG)
        reader.listen_to(f"zmq+sub+curve.{key}+password.{password}://{where}")
        wait_until(lambda: socket.send(b"hello") is None and reader.poll() is not None)


def test_a_password_of_a_socket_that_dials_is_a_token(
    names: yarpy.LocalNames,
    sockets: Sockets,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    token = "4Zr2kXqyJtWm0v8N"
    rule = '[[allow]]\nwho = "token:visitors"\nmay = ["read"]\n[tokens]\nvisitors = "%s"\n'
    write(tmp_path, monkeypatch, rule % token)
    with yarpy.Port("/out", names=names) as out:
        other = {"PLAIN_USERNAME": b"me", "PLAIN_PASSWORD": b"other"}
        assert sockets.is_turned_away(zmq.SUB, out, **other)
        socket = sockets.subscriber(out, b"", PLAIN_USERNAME=b"me", PLAIN_PASSWORD=token.encode())
        out.write("hello")
        assert socket.recv_multipart() == [b"/out", b'"hello"']
        assert token not in caplog.text


def test_sockets_with_a_key_dial_a_port(
    names: yarpy.LocalNames,
    sockets: Sockets,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    if not zmq.has("curve"):
        pytest.skip("this libzmq has no CURVE: pip install pyzmq brings one that has")
    ours, secret = zmq.curve_keypair()
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    (tmp_path / "curve.key").write_text(z85.decode(secret).hex())
    (tmp_path / "curve.key").chmod(0o600)
    public, own = zmq.curve_keypair()
    known = {"CURVE_SERVERKEY": ours, "CURVE_PUBLICKEY": public, "CURVE_SECRETKEY": own}
    rules = (
        '[[allow]]\nwho = "token:arm"\nmay = ["read", "write"]\n[tokens]\narm = {curve = "%s"}\n'
    )
    write(tmp_path, monkeypatch, rules % z85.decode(public).hex())
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
        yarpy.RpcServer("/double", lambda message: [2 * message.value], names=names) as server,
    ):
        other, strange = zmq.curve_keypair()
        for wrong in (
            {"CURVE_SERVERKEY": other},  # of another port
            {"CURVE_PUBLICKEY": other, "CURVE_SECRETKEY": strange},  # nobody's
        ):
            assert sockets.is_turned_away(zmq.SUB, out, **{**known, **wrong})
        assert sockets.is_turned_away(zmq.SUB, out)  # without a key
        socket = sockets.subscriber(out, b"", **known)
        for value in ("hello", "x" * 100_000):
            out.write(value)
            assert socket.recv_multipart() == [b"/out", b'"%s"' % value.encode()]
        sockets.connected(zmq.PUSH, reader, **known).send_multipart([b"[1]", b"y" * 100_000])
        assert reader.read(timeout=HANG).value == [[1], "y" * 100_000]
        asker = sockets.connected(zmq.REQ, server, **known)
        asker.send(b"21")
        assert asker.recv_json() == [42]
    assert z85.decode(secret).hex() not in caplog.text


class Doorkeeper:
    """Says who may come in to the sockets of a context that ask for names and passwords (ZAP)."""

    def __init__(
        self, context: Any, known: dict[bytes, bytes] | None = None, keys: set[bytes] | None = None
    ) -> None:
        self._known = known or {}
        self._keys = keys or set()
        self._socket = context.socket(zmq.REP)
        self._socket.linger = 0
        self._socket.bind("inproc://zeromq.zap.01")
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="doorkeeper")

    def _run(self) -> None:
        while not self._over.is_set():
            if self._socket.poll(20):
                version, number, _, _, _, mechanism, *shown = self._socket.recv_multipart()
                if mechanism == b"CURVE":
                    admitted = shown[0] in self._keys
                else:
                    admitted = self._known.get(shown[0]) == shown[1]
                status = b"200" if admitted else b"400"
                self._socket.send_multipart([version, number, status, b"", b"", b""])

    def __enter__(self) -> None:
        self._thread.start()

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join(HANG)
        self._socket.close()


def test_a_pair_is_told_no(
    out: yarpy.Port, sockets: Sockets, caplog: pytest.LogCaptureFixture
) -> None:
    sockets.connected(zmq.PAIR, out)
    wait_until(lambda: "does not speak with a PAIR" in caplog.text)
    assert not out.outputs


def test_a_stream_speaks_the_carrier_for_text(names: yarpy.LocalNames, sockets: Sockets) -> None:
    """It speaks nothing of ZeroMQ: to a port it is a plain connection over TCP."""
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        stream = sockets.connected(zmq.STREAM, port)
        ours = stream.getsockopt(zmq.ROUTING_ID)
        assert stream.recv_multipart() == [ours, b""]  # it is connected
        stream.send_multipart([ours, b"CONNECT /me\r\n"])
        assert stream.recv_multipart() == [ours, b"Welcome /me\r\n"]
        stream.send_multipart([ours, b"d\r\nfast 1\r\n"])
        message = port.read(timeout=HANG)
        assert message is not None and (message.value, message.source) == (["fast", 1], "/me")


def test_rules_of_access_hold(
    names: yarpy.LocalNames,
    sockets: Sockets,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.Port("/readable", names=names) as port:
        socket = sockets.subscriber(port, b"")
        port.write([1])
        assert socket.recv_multipart()[1] == b"[1]"
        for kind in (zmq.PUSH, zmq.PUB, zmq.REQ):
            assert sockets.is_turned_away(kind, port)
        assert not port.inputs
    allow(tmp_path, monkeypatch, "write")
    with yarpy.BufferedPort("/writable", names=names) as port:
        push = sockets.connected(zmq.PUSH, port)
        push.send(b"[1]")
        assert port.read(timeout=HANG).value == yarpy.Bottle([1])
        assert sockets.is_turned_away(zmq.SUB, port)
        assert not port.outputs
