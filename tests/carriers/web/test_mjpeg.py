"""mjpeg: the captures byte for byte, cameras with habits of their own, the conformance suite."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.capture import load_capture
from support.steps import chop, measured

from yarpy.carriers.web.mjpeg import Mjpeg
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, YarpError
from yarpy.limit import MJPEG_FRAME
from yarpy.link.begin.handshake import recognise
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End, said
from yarpy.wire.effects import Open
from yarpy.wire.message import Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

Y, X = np.mgrid[:16, :24]
COLOUR = Image(np.stack([X * 9, Y * 9, X + Y], -1).astype("u1"))
GREY = Image((X * 9).astype("u1"))
FRAME = jpeg.encode(COLOUR)
PIECES = [0, 1, 7]


class TestMjpeg(CarrierConformance):
    carrier = Mjpeg
    names_sender = False
    values = (COLOUR, GREY, np.zeros((5, 7, 3), "u1"), Image(np.full((3, 9, 4), 80, "u1"), "bgra"))
    sizes = (1, 100, 4096, 20_000)

    def expected(self, value: Any) -> Any:
        image = value if isinstance(value, Image) else Image(value)
        return Image.from_wire(jpeg.decode(jpeg.encode(image)))

    def of_size(self, size: int) -> Any:
        chance = np.random.default_rng(size)
        return Image(chance.integers(0, 255, (max(1, size // 50), 50), "u1"))

    def _recorded(self) -> bytes:
        end, carrier = self._greeted().sender
        carrier.encode(end.stream, Packet(COLOUR, b"7 1.25"))
        return end.take()


# ------------------------------------------------------------------------------------ the captures


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("name", ["mjpeg_action_stream", "mjpeg_cpp_to_cpp"])
def test_requests_are_answered_as_by_cpp(name: str, piece: int) -> None:
    capture = load_capture(name)
    request = capture.steps[0].data
    assert recognise(request[:8]) is Mjpeg
    end, carrier = End(piece), Mjpeg(Route("", "/cap/out", "mjpeg"))
    end.begin(carrier.welcome(end.stream, request[:8]))
    end.feed(request[8:])
    if (
        b"User-Agent" in request
    ):  # perhaps somebody looks at it: what he is told waits for a message
        assert not end.take()
        assert carrier.prepare(Packet(COLOUR))
        carrier.encode(end.stream, Packet(COLOUR))
    answer = capture.said("b")
    mark = b"--boundarydonotcross\r\n"
    head = answer[: answer.index(mark) + len(mark)]
    assert end.take()[: len(head)] == head
    assert carrier.route.source == "null"
    assert carrier.route.carrier == "mjpeg"


def test_frame_is_framed_and_compressed_as_by_cpp() -> None:
    """The grey picture of the capture is (10 x + y), with the envelope 3 4.5: byte for byte."""
    pixels = np.array([[0, 10, 20, 30], [1, 11, 21, 31]], "u1")
    stream = ByteStream()
    Mjpeg(Route("", "")).encode(stream, Packet(Image(pixels), b"3 4.5"))
    said_ = b"".join(bytes(part) for part in stream.take_output())
    answer = load_capture("mjpeg_cpp_to_cpp").said("b")
    assert answer.endswith(b"--boundarydonotcross\r\n" + said_)
    assert len(said_) == 419


@pytest.mark.parametrize("piece", PIECES)
def test_frames_of_cpp_are_understood(piece: int) -> None:
    answer = load_capture("mjpeg_cpp_to_cpp").steps[1].data
    carrier, found = watch(answer, 3, piece)
    assert [(m.key, m.envelope, m.value.code, m.value.width) for m in found] == [
        ("D", "", "rgb", 4),
        ("D", "3 4.5", "rgb", 4),
        ("D", "3 4.5", "mono", 4),
    ]
    assert np.abs(found[2].value.array.astype(int) - [[0, 10, 20, 30], [1, 11, 21, 31]]).max() < 3
    assert carrier.lost == 0


def dialled(carrier: str, *answers: bytes) -> tuple[Mjpeg, list[bytes], str]:
    """A camera's answers, each in a connection of its own: the carrier, what it asked, and why it
    gives up, if it does."""
    end, watcher = End(), Mjpeg(Route("", "", carrier, 80, "cam"))
    end.begin(watcher.greet(end.stream))
    asked = [end.take()]
    try:
        for head in answers:
            end.feed(head)
            asked.append(end.take())
    except RemoteProtocolError as error:
        return watcher, asked, str(error)
    assert end.opened == [Open("", listen=False)] * (len(answers) - 1)
    return watcher, asked, ""


WANTS = b'HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: %s realm="cam"%s\r\n\r\n'
BASIC = WANTS % (b"Basic", b"")
DIGEST = WANTS % (b"Digest", b', nonce="77", qop="auth"')
SECRET = "mjpeg+path.video+user.me%2Byou+password.p.a%3As"


def test_name_and_password() -> None:
    """The camera asks first; then it gets what it asked for, on a connection of its own."""
    clear = b"\r\nAuthorization: Basic %s\r\n\r\n" % b64encode(b"me+you:p.a:s")
    hashed = b'\r\nAuthorization: Digest username="me+you"'
    for wants, login in ((BASIC, clear), (DIGEST, hashed)):
        watcher, asked, why = dialled(SECRET, wants, answer())
        assert asked[0] == request("mjpeg+path.video", "cam", 80)
        assert asked[1].startswith(asked[0][:-2])
        assert login in asked[1]
        assert asked[1].endswith(b"\r\n\r\n")
        assert (asked[2:], why) == ([b""], "")
        assert watcher.route.carrier == "mjpeg+path.video+user.me%2Byou+password.***"
        assert watcher.route.spec.whole == SECRET
        assert "p.a" not in repr(watcher.route) + str(watcher.route) + why


def test_open_camera_is_told_no_password() -> None:
    _, asked, why = dialled(SECRET, answer())
    assert asked == [request("mjpeg+path.video", "cam", 80), b""]
    assert why == ""


def test_digest_is_for_what_is_asked() -> None:
    _, asked, _ = dialled("mjpeg+path.a/b?c=d,e+user.u+password.p", DIGEST, answer())
    assert asked[1].startswith(b"GET /a/b?c=d,e HTTP/1.0\r\n")
    assert b' uri="/a/b?c=d,e",' in asked[1]


@pytest.mark.parametrize("wants", [BASIC, DIGEST])
def test_wrong_password_is_tried_once(wants: bytes) -> None:
    watcher, asked, why = dialled(SECRET, wants, wants)
    assert len(asked) == 2
    assert "does not accept this name and password" in why
    assert "p.a" not in why
    assert "***" in watcher.route.carrier


@pytest.mark.parametrize("wants", [BASIC, DIGEST])
def test_password_that_is_wanted(wants: bytes) -> None:
    watcher, asked, why = dialled("mjpeg+path.video", wants)
    assert "user.<name>+password.<word>" in why
    assert len(asked) == 1
    assert watcher.route.carrier == "mjpeg+path.video"


# ------------------------------------------------------------------------------------ the sender


def test_options_of_a_browser() -> None:
    for query, quality, interval, carrier in (
        (b"tion=stream", 75, 0, "mjpeg"),
        (b"tion=stream&quality=30", 30, 0, "mjpeg+quality.30"),
        (b"tion=stream&rate=10&quality=100", 100, 0.1, "mjpeg+quality.100+rate.10"),
        (b"tion=stream&rate=2.5", 75, 0.4, "mjpeg+rate.2.5"),
        (b"&" * 100, 75, 0, "mjpeg"),
    ):
        end, speaker = End(), Mjpeg(Route("", "/p", "mjpeg"))
        end.begin(speaker.welcome(end.stream, b"GET /?ac"))
        end.feed(query + b" HTTP/1.1\r\nHost: x\r\n\r\n")
        assert end.done
        assert (speaker.quality, speaker.delivery.interval, speaker.route.carrier) == (
            quality,
            interval,
            carrier,
        )


@pytest.mark.parametrize(
    ("query", "text"),
    [
        (b"tion=stream&rate=-1", b"rate must be a number from 0.001 to 1000, not '-1'"),
        (b"tion=stream&rate=nan", b"rate must be a number"),
        (b"tion=stream&quality=", b"quality must be a number from 1 to 100, not ''"),
        (b"tion=snapshot&quality=900", b"quality must be a number from 1 to 100, not '900'"),
        (b"tion=stream&quality=7.5", b"quality must be a whole number"),
        (b"tion=command&id=1", b"action must be stream or snapshot, not 'command'"),
    ],
)
def test_options_that_nobody_can_grant(query: bytes, text: bytes) -> None:
    end, speaker = End(), Mjpeg(Route("", "/p", "mjpeg"))
    end.begin(speaker.welcome(end.stream, b"GET /?ac"))
    end.feed(query + b" HTTP/1.1\r\nHost: x\r\nUser-Agent: x\r\n\r\n")
    said = end.take()
    assert said.startswith(b"HTTP/1.1 400 Bad Request\r\n")
    assert text in said.partition(b"\r\n\r\n")[2]
    with pytest.raises(RemoteProtocolError):
        end.feed_eof()


def asked_by_browser(query: bytes) -> tuple[End, Mjpeg]:
    end, speaker = End(), Mjpeg(Route("/cam", "/p", "mjpeg"))
    end.begin(speaker.welcome(end.stream, b"GET /?ac"))
    end.feed(query + b" HTTP/1.1\r\nHost: x\r\nUser-Agent: Mozilla\r\n\r\n")
    assert end.done and not end.take()
    speaker.route.source = "/cam"  # as the port does
    return end, speaker


def test_a_snapshot_is_one_jpeg() -> None:
    end, speaker = asked_by_browser(b"tion=snapshot&quality=90")
    for _ in range(2):
        assert speaker._done or speaker.prepare(Packet(COLOUR, b"7 1.25"))
        speaker.encode(end.stream, Packet(COLOUR, b"7 1.25"))
    head, _, data = end.take().partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\n")
    assert b"Content-Length: %d" % len(data) in head
    assert jpeg.comment(data) == "7 1.25"
    with pytest.raises(LinkClosed):
        speaker.prepare(Packet(COLOUR))


@pytest.mark.parametrize("action", [b"stream", b"snapshot"])
def test_port_without_pictures_says_so(action: bytes) -> None:
    end, speaker = asked_by_browser(b"tion=" + action)
    assert speaker.prepare(Packet([1, 2]))
    speaker.encode(end.stream, Packet([1, 2]))
    said = end.take()
    assert said.startswith(b"HTTP/1.1 404 Not Found\r\n")
    assert said.endswith(b"/cam sends no pictures; see what it sends at /r\n")


def test_stream_that_has_begun_skips_what_is_no_picture() -> None:
    end, speaker = asked_by_browser(b"tion=stream")
    speaker.encode(end.stream, Packet(COLOUR))
    assert end.take().startswith(b"HTTP/1.0 200 OK\r\n")
    assert not speaker.prepare(Packet([1, 2]))


def test_scripts_of_other_pages_may_look() -> None:
    end, speaker = End(), Mjpeg(Route("", "/p", "mjpeg"))
    end.begin(speaker.welcome(end.stream, b"GET /?ac"))
    end.feed(b"tion=stream HTTP/1.1\r\nHost: x\r\nOrigin: http://h:1\r\n\r\n")
    head, _, rest = end.take().partition(b"\r\n\r\n")
    assert head.endswith(b"\r\nAccess-Control-Allow-Origin: *")
    assert rest == b"--boundarydonotcross\r\n"


def test_options_travel_between_ports() -> None:
    talk = Dialogue(Mjpeg, "+quality.20+rate.5")
    talk.greet()
    assert said(talk.traffic, "initiator").startswith(b"GET /?action=stream&quality=20&rate=5 ")
    assert isinstance(talk.accepting, Mjpeg)
    assert (talk.accepting.quality, talk.accepting.delivery.interval) == (20, 0.2)


def test_one_compression_for_all_of_one_quality(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    encode = jpeg.encode
    monkeypatch.setattr(jpeg, "encode", lambda i, q: (asked.append(q), encode(i, q))[1])
    packet = Packet(COLOUR)
    for quality in (75, 75, 30, 75, 30):
        carrier, stream = Mjpeg(Route("", "")), ByteStream()
        carrier.quality = quality
        assert carrier.prepare(packet)
        carrier.encode(stream, packet)
        assert stream.pending
    assert asked == [75, 30]


@pytest.mark.parametrize(
    "value",
    [[], [1, "two"], "text", 5, b"\0" * 100, {"a": 1}, np.zeros(9), Image(np.zeros((0, 0), "u1"))],
    ids=repr,
)
def test_what_is_no_picture_is_not_sent(value: object) -> None:
    carrier, stream = Mjpeg(Route("", "")), ByteStream()
    packet = Packet(value)
    assert not carrier.prepare(packet)
    carrier.encode(stream, packet)
    assert not stream.pending


class Foreign:
    """A picture as somebody else's class spells it."""

    def to_wire(self) -> tuple[bytes, ...]:
        return (b"".join(bytes(block) for block in COLOUR.to_wire()),)


@pytest.mark.parametrize("value", [COLOUR.array, Foreign()], ids=["array", "wire"])
def test_pictures_of_other_classes(value: object) -> None:
    one, other = ByteStream(), ByteStream()
    Mjpeg(Route("", "")).encode(one, Packet(value))
    Mjpeg(Route("", "")).encode(other, Packet(COLOUR))
    assert one.take_output() == other.take_output()


# ---------------------------------------------------------------------------------- the receiver


def request(carrier: str, host: str = "cam.local", port: int = 8080) -> bytes:
    stream = ByteStream()
    next(Mjpeg(Route("/c", "/view", carrier, port, host)).greet(stream), None)
    return b"".join(bytes(part) for part in stream.take_output())


def test_request() -> None:
    assert request("mjpeg+path.mjpg/video.mjpg?camera=1") == (
        b"GET /mjpg/video.mjpg?camera=1 HTTP/1.0\r\n"
        b"Host: cam.local:8080\r\n"
        b"User-Agent: yarpy\r\n"
        b"Accept: multipart/x-mixed-replace, image/jpeg\r\n"
        b"\r\n"
    )
    assert request("mjpeg").startswith(b"GET /?action=stream HTTP/1.0\r\n")
    assert request("mjpeg+path./a").startswith(b"GET /a HTTP/1.0\r\n")
    assert b"Host: [::1]:80\r\n" in request("mjpeg", "::1", 80)


@pytest.mark.parametrize("path", ["a b", "a\r\nX: y", "a\x00"])
def test_path_that_would_be_another_request(path: str) -> None:
    with pytest.raises(LocalProtocolError, match="path"):
        request(f"mjpeg+path.{path}")


def answer(mark: bytes = b"boundary=x") -> bytes:
    return b"HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; " + mark + b"\r\n\r\n"


SIZE = str(len(FRAME)).encode()
HABITS = {
    "plain": answer() + b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %s\r\n\r\n%s\r\n",
    "boundary with its dashes": answer(b"boundary=--x")
    + b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %s\r\n\r\n%s\r\n",
    "boundary in quotes": answer(b'boundary="x"')
    + b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %s\r\n\r\n%s\r\n",
    "boundary not told": b"HTTP/1.0 200\r\nContent-Type: multipart/x-mixed-replace\r\n\r\n"
    b"--anything\r\nContent-Type: image/jpeg\r\nContent-Length: %s\r\n\r\n%s\r\n",
    "order": answer() + b"--x\r\nContent-Length: %s\r\nContent-Type: image/jpeg\r\n\r\n%s\r\n",
    "case": answer() + b"--x\r\ncontent-type: IMAGE/JPEG\r\ncontent-LENGTH:%s\r\n\r\n%s\r\n",
    "more headers": answer()
    + b"--x\r\nX-A: b\r\nContent-Type: image/jpeg\r\nX-B: c\r\nContent-Length: %s \r\n\r\n%s\r\n",
    "no type": answer() + b"--x\r\nContent-Length: %s\r\n\r\n%s\r\n",
    "line feeds": b"HTTP/1.0 200 OK\nContent-Type: multipart/mixed; boundary=x\n\n"
    b"--x\nContent-Type: image/jpeg\nContent-Length: %s\n\n%s\n",
    "no line end behind a picture": answer() + b"--x\r\nContent-Length: %s\r\n\r\n%s",
    "empty lines": answer() + b"\r\n\r\n--x\r\nContent-Length: %s\r\n\r\n%s\r\n\r\n",
    "no length": answer() + b"--x\r\nContent-Type: image/jpeg\r\n\r\n%.0s%s\r\n",
    "no length, no line end": answer() + b"--x\r\nContent-Type: image/jpeg\r\n\r\n%.0s%s",
    "foolish length": answer() + b"--x\r\nContent-Length: -7\r\n\r\n%.0s%s\r\n",
}


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("habit", HABITS)
def test_habits_of_cameras(habit: str, piece: int) -> None:
    whole = HABITS[habit] % (SIZE, FRAME)
    head = whole.index(b"\n\n" if habit == "line feeds" else b"\r\n\r\n") + 2
    part = whole[whole.index(b"--", head) :]
    carrier, found = watch(whole + part + part, 3, piece)
    assert len(found) == 3
    assert carrier.lost == 0
    assert all(m.value == Image.from_wire(jpeg.decode(FRAME)) for m in found)


@pytest.mark.parametrize("size", [1, 10, 500, 5000])
@pytest.mark.parametrize("piece", PIECES)
def test_chunks_of_ffmpeg(size: int, piece: int) -> None:
    """As ffmpeg answers with `-f mpjpeg -listen 1`, whatever it is asked."""
    head = b"HTTP/1.1 200 OK\r\nContent-Type: application/octet-stream\r\n"
    head += b"Transfer-Encoding: chunked\r\n\r\na\r\n--ffmpeg\r\n\r\n"
    one = b"Content-type: image/jpeg\r\nContent-length: %d\r\n\r\n" % len(FRAME)
    body = (one + FRAME + b"\r\n--ffmpeg\r\n") * 4
    cuts = [body[at : at + size] for at in range(0, len(body), size)]
    chunked = b"".join(b"%x\r\n" % len(cut) + cut + b"\r\n" for cut in cuts)
    carrier, found = watch(head + chunked, 4, piece)
    assert len(found) == 4
    assert carrier.lost == 0
    assert all(m.value == Image.from_wire(jpeg.decode(FRAME)) for m in found)


def part(data: bytes, size: object = None, kind: bytes = b"image/jpeg") -> bytes:
    length = b"" if size == "" else b"Content-Length: %d\r\n" % (size or len(data))
    return b"--x\r\nContent-Type: " + kind + b"\r\n" + length + b"\r\n" + data + b"\r\n"


TROUBLES = {
    "cut off": (part(FRAME[:-30]), 1),
    "damaged": (part(FRAME.replace(b"\xff\xda", b"zz")), 1),
    "no picture": (part(b"hello"), 1),
    "empty": (b"--x\r\nContent-Length: 0\r\n\r\n\r\n", 1),
    "another type": (part(b"<svg/>", kind=b"image/svg+xml"), 1),
    "too short a length": (part(FRAME, len(FRAME) - 100), 1),
    "no length, cut off": (part(FRAME[:-30], ""), 1),
    "no length, no picture": (part(b"hello", ""), 1),
    "no length, damaged": (part(FRAME.replace(b"\xff\xda", b"zz"), ""), 1),
    "rubbish between": (b"\xff\xd8rubbish\r\n-- \r\n\0\0\n", 0),
}


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("trouble", TROUBLES)
def test_trouble_costs_its_own_picture(trouble: str, piece: int) -> None:
    data, lost = TROUBLES[trouble]
    carrier, found = watch(answer() + part(FRAME) + data + part(FRAME) + part(FRAME), 3, piece)
    assert len(found) == 3
    assert carrier.lost == lost


def test_length_that_covers_the_next_boundary() -> None:
    """The picture itself is whole; the one behind it is lost."""
    data = part(FRAME, len(FRAME) + 30)
    _, found = watch(answer() + data + part(FRAME) + part(FRAME) + part(FRAME), 3)
    assert len(found) == 3


@pytest.mark.parametrize(
    "data",
    [
        b"HTTP/1.1 404 Not Found\r\n\r\n",
        b"HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic\r\n\r\n",
        b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n\r\n<html>",
        b"HTTP/1.1 200 OK\r\n\r\n",
        b"\r\n",
        b"SSH-2.0-OpenSSH_9\r\n",
        b"HTTP/1.1 200 OK\r\n" + b"a: b\r\n" * 1000,
        b"HTTP/1.1 200 OK\r\nx: " + b"a" * 100_000,
        answer(b"boundary=x\r\nTransfer-Encoding: chunked") + b"no size\r\n",
    ],
)
def test_answers_that_are_no_stream(data: bytes) -> None:
    with pytest.raises(RemoteProtocolError):
        watch(data, 1)


def test_announced_size_is_limited() -> None:
    for size in (b"%d" % (MJPEG_FRAME + 1), b"9" * 5000):
        with measured() as peak, pytest.raises(RemoteProtocolError, match="the limit is"):
            watch(answer() + b"--x\r\nContent-Length: " + size + b"\r\n\r\n", 1)
        assert peak.bytes < 1 << 20


@pytest.mark.parametrize("data", [b"--x--\r\n", part(FRAME, "")[:-2] + b"\r\n--x--\r\n"])
def test_end_of_the_stream(data: bytes) -> None:
    with pytest.raises(LinkClosed, match="ended"):
        watch(answer() + part(FRAME) + data, 9)


@settings(max_examples=200)
@given(st.data())
def test_whatever_comes_only_our_errors(data: st.DataObject) -> None:
    wire = bytearray(answer() + part(FRAME, "") + part(FRAME) + part(FRAME[:50], ""))
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(wire)))
        count = data.draw(st.integers(0, 20))
        wire[at : at + count] = data.draw(st.binary(max_size=20))
    try:
        watch(bytes(wire), 5, data.draw(st.sampled_from([0, 5])))
    except YarpError:
        pass


def watch(data: bytes, count: int, piece: int = 0) -> tuple[Mjpeg, list[Message]]:
    """What a receiver finds in the answer of a camera."""
    end, carrier = End(), Mjpeg(Route("/view", "/cam", "mjpeg", 80, "h"))
    found: list[Message] = []

    def steps() -> Steps[None]:
        yield from carrier.greet(end.stream)
        while len(found) < count:
            found.append((yield from carrier.decode(end.stream)))

    end.begin(steps())
    for bit in chop(data, piece):
        if end.done:
            break
        end.feed(bit)
    if not end.done:
        end.feed_eof()
    return carrier, found
