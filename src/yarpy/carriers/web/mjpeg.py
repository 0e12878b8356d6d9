"""mjpeg: pictures for browsers, and from network cameras: JPEG files in an endless HTTP answer.

    GET /?action=stream HTTP/1.1            the dialling side is the watcher
    GET /?action=snapshot HTTP/1.1          only the next picture

    HTTP/1.0 200 OK ... Content-Type: multipart/x-mixed-replace;boundary=boundarydonotcross
    --boundarydonotcross
    Content-Type: image/jpeg
    Content-Length: 734

Rules: a slow watcher gets fewer pictures, the port never waits for it. A picture is compressed once
for all watchers that want the same quality (`/?action=stream&quality=50&rate=10`, or
`mjpeg+quality.50+rate.10` between ports; rate in pictures per second). Messages that are not
pictures are dropped and counted; browsers, which get their answer with the first message, are told
that there are no pictures. The envelope is the comment in the JPEG file. Cameras may reorder,
misspell or omit headers, or send in chunks; a damaged picture is dropped, and counted in `lost`. A
camera that asks for a password is dialled again with the answer from `http/login.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from yarpy.carriers.base import OVER_TCP, Carrier, Delivery
from yarpy.carriers.web.http.chunk import Chunks
from yarpy.carriers.web.http.header import CHALLENGES, read_headers
from yarpy.carriers.web.http.login import refusal, take_login
from yarpy.carriers.web.http.message import TEXT, response_head
from yarpy.carriers.web.http.refusal import refuse, screen, screen_page
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image, is_image
from yarpy.errors import DecodeError, LinkClosed, LocalProtocolError, RemoteProtocolError
from yarpy.facts import SERVER
from yarpy.limit import HTTP_LINE, MJPEG_FRAME
from yarpy.route import Route
from yarpy.wire.effects import HEAR, Open, Switch
from yarpy.wire.message import DATA, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

_BOUNDARY: Final = b"--boundarydonotcross\r\n"
_ANSWER: Final = (
    b"HTTP/1.0 200 OK\r\n"
    b"Connection: close\r\n"
    b"Server: yarp/mjpeg_carrier/0.1\r\n"
    b"Cache-Control: no-store, no-cache, must-revalidate, pre-check=0, post-check=0, max-age=0\r\n"
    b"Pragma: no-cache\r\n"
    b"Expires: Mon, 3 Jan 2000 12:34:56 GMT\r\n"
    b"Content-Type: multipart/x-mixed-replace;boundary=boundarydonotcross\r\n"
)
_LAST: Final = (
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("Connection", "close"),
)


class Mjpeg(Carrier):
    """Images only, from the dialled port to the one that dialled."""

    name = "mjpeg"
    words = ("path.PATH", "quality.N", "rate.N", "user.NAME", "password.WORD", *OVER_TCP)
    magic = b"GET /?ac"
    push = False
    replies = False
    reaches = SERVER
    delivery = Delivery(lossy=True, backlog=1, coalesces=False)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.quality = jpeg.QUALITY
        self._mark = b"--"  # marks the line between two pictures
        self._past_mark = False  # inside that line: its end is next
        self._once = False  # a single picture was requested, not a stream
        self._asked = False  # the answer begins with the first message
        self._done = False  # the answer is complete
        self._shared = b""  # a header of the answer
        self._chunks: Chunks | None = None  # a camera's chunked encoding

    # -- the sender -------------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        line = bytes(first) + (yield from stream.read_line(HTTP_LINE))
        headers = yield from read_headers(stream)
        yield from screen_page(stream, headers, self.route)
        try:
            target = line.decode("latin-1").split()[1]
            options = read_stream_options((yield from screen(stream, target, headers, HEAR)))
        except ValueError as error:
            yield from refuse(stream, 400, str(error))
        self.begin(stream, options, headers)

    def begin(self, stream: ByteStream, options: StreamOptions, headers: Mapping[str, str]) -> None:
        """Answer a request."""
        self.route.source = "null"  # watchers have no names; C++ calls them that
        self._once = options.once
        if options.quality:
            self.quality = options.quality
            self.route.spec = self.route.spec.plus(f"quality.{self.quality}")
        if options.rate:
            self.delivery = replace(self.delivery, interval=1 / options.rate)
            self.route.spec = self.route.spec.plus(f"rate.{options.rate:g}")
        # Whoever came so far may read it with a script, like everything that ports publish.
        self._shared = b"Access-Control-Allow-Origin: *\r\n" if "origin" in headers else b""
        agent = headers.get("user-agent", "yarp")
        if self._once or "yarp" not in agent.lower():
            self._asked = True  # answered later, to tell people if there are no pictures
        else:
            stream.write(_ANSWER + self._shared + b"\r\n" + _BOUNDARY)

    def _plain(self, status: int, text: str) -> bytes:
        body = f"{text}\n".encode()
        headers = (("Content-Type", TEXT), ("Content-Length", str(len(body))), *_LAST)
        head = response_head(status, headers)
        return head.removesuffix(b"\r\n") + self._shared + b"\r\n" + body

    def prepare(self, packet: Packet) -> bool:
        if self._done:
            raise LinkClosed("the requested picture was sent")
        return bool(self._frame(packet)) or self._asked

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        frame = self._frame(packet)
        if self._done:
            return  # it was queued behind the requested picture
        if not self._asked:
            stream.write(*frame)
            return
        self._asked = False
        if not frame:
            name = self.route.source
            stream.write(self._plain(404, f"{name} sends no pictures; see what it sends at /r"))
            self._done = True
        elif self._once:
            size = ("Content-Length", str(len(frame[1])))
            head = response_head(200, (("Content-Type", "image/jpeg"), size, *_LAST))
            stream.write(head.removesuffix(b"\r\n") + self._shared + b"\r\n", frame[1])
            self._done = True
        else:
            stream.write(_ANSWER + self._shared + b"\r\n" + _BOUNDARY, *frame)

    def _frame(self, packet: Packet) -> tuple[Buffer, ...]:
        """The part of the answer with a packet's picture; empty if it is not a picture."""
        key = (self.name, self.quality)
        frame = packet.forms.get(key)
        if frame is None:
            frame = packet.forms[key] = _compressed(packet, self.quality)
        return frame

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the answer."""

    # -- the receiver -----------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        login = take_login(self.route)
        path = self._path()
        admitted, headers = yield from self._ask(stream, path)
        if not admitted and login is not None:
            answer = login.answer(headers.get(CHALLENGES, ""), path.encode())
            # Most cameras hang up after a refusal, so the login goes over a new connection.
            again = yield Open("", listen=False)
            stream = ByteStream(stream.limit)
            yield Switch(again, stream)
            admitted, headers = yield from self._ask(stream, path, answer)
        if not admitted:
            raise refusal(headers.get(CHALLENGES, ""), login)
        kind, _, options = headers.get("content-type", "").partition(";")
        kind = kind.strip().lower()
        # As a server, ffmpeg always says octet-stream.
        if kind != "application/octet-stream" and not kind.startswith("multipart/"):
            raise RemoteProtocolError(
                f"{path} is not a stream of pictures but {kind or 'of unknown type'}"
                "; name the camera's stream with the carrier mjpeg+path.<path>"
            )
        if "chunked" in headers.get("transfer-encoding", "").lower():
            self._chunks = Chunks(stream.limit)  # which HTTP/1.0 does not have
        for option in options.split(";"):
            key, _, value = option.partition("=")
            if key.strip().lower() == "boundary":
                self._mark = b"--" + value.strip().strip('"').lstrip("-").encode("latin-1")

    def _ask(
        self, stream: ByteStream, path: str, login: bytes = b""
    ) -> Steps[tuple[bool, dict[str, str]]]:
        """Return whether the camera accepts us, and the headers of its answer."""
        stream.write(self._request(path, login))
        line = yield from stream.read_line(HTTP_LINE)
        words = line.split(None, 2)
        if len(words) < 2 or not words[0].startswith(b"HTTP/") or words[1] not in (b"200", b"401"):
            text = line[:80].decode("utf-8", "replace")
            raise RemoteProtocolError(
                f'the camera answers "{text}" to {path}; name its stream with the carrier '
                "mjpeg+path.<path>"
            )
        return words[1] == b"200", (yield from read_headers(stream))

    def _request(self, path: str, login: bytes) -> bytes:
        route = self.route
        host = f"[{route.host}]" if ":" in route.host else route.host
        # HTTP/1.0, so that the answer does not come in chunks.
        lines = [
            f"GET {path} HTTP/1.0",
            f"Host: {host}:{route.port}",
            "User-Agent: yarpy",
            "Accept: multipart/x-mixed-replace, image/jpeg",
        ]
        head = "\r\n".join(lines).encode()
        return head + (b"\r\nAuthorization: " + login if login else b"") + b"\r\n\r\n"

    def _path(self) -> str:
        spec = self.route.spec
        path = spec.value("path")
        if path is None:
            path = "?action=stream"
            for wish in ("quality", "rate"):
                value = spec.value(wish)
                if value is not None:
                    path += f"&{wish}={value}"
        if not path.isprintable() or " " in path:
            raise LocalProtocolError(f"the path {path!r} contains blanks: write %20 for each")
        return "/" + path.removeprefix("/")

    def decode(self, stream: ByteStream) -> Steps[Message]:
        chunks = self._chunks
        if chunks is None:
            return (yield from self._read_picture(stream))
        message = yield from chunks.through(stream, self._read_picture(chunks.inner))
        return message

    def _read_picture(self, stream: ByteStream) -> Steps[Message]:
        while True:
            data = yield from self._read_part(stream)
            try:
                picture = jpeg.decode(data, stream.limit)
            except DecodeError:
                self.lost += 1
                continue
            return Message(DATA, picture, jpeg.comment(data))

    def _read_part(self, stream: ByteStream) -> Steps[bytes | memoryview | bytearray]:
        """The next JPEG file."""
        while True:
            if not self._past_mark:
                yield from self._skip_to_mark(stream)
            elif (yield from stream.read_line(HTTP_LINE)).startswith(b"--"):
                raise LinkClosed("the camera has ended its stream")
            self._past_mark = False
            stream.pause()  # cameras send the separator of the next picture right after each one
            headers = yield from read_headers(stream)
            kind = headers.get("content-type", "image/jpeg").partition(";")[0].strip().lower()
            size = headers.get("content-length", "")
            if not (size.isascii() and size.isdigit()):
                data: bytes | memoryview | bytearray = yield from self._read_unmeasured(stream)
            elif len(size) > 9 or int(size) > MJPEG_FRAME:
                raise RemoteProtocolError(
                    f"the camera announces a picture of {size[:20]} bytes; "
                    f"the limit is {MJPEG_FRAME}"
                )
            else:
                data = yield from stream.read_exact(int(size))
            if kind in ("image/jpeg", "image/jpg", "image/pjpeg") and data:
                return data
            self.lost += 1

    def _skip_to_mark(self, stream: ByteStream) -> Steps[None]:
        """Skip everything up to the line that begins a part."""
        while True:
            line = yield from stream.read_line(MJPEG_FRAME)
            if line.startswith(b"--") and self._mark in line and len(line) < 200:
                if line.endswith(b"--") and len(line) > len(self._mark) and line != self._mark:
                    raise LinkClosed("the camera has ended its stream")
                return
            if not line:
                stream.pause()

    def _read_unmeasured(self, stream: ByteStream) -> Steps[bytearray]:
        """A JPEG file of unknown length: up to its end, or to the line that begins the next."""
        data = bytearray()
        extent = jpeg.Extent()
        whole = True  # so far
        mark = b"\n" + self._mark
        while True:
            yield from stream.more(1)
            searched = max(0, len(data) - len(mark))
            data += stream.buffer[stream.head : stream.tail]
            stop = data.find(mark, searched)
            end = extent.advance(data) if whole else -1
            whole = end >= 0
            if end > 0 and (stop < 0 or end <= stop):
                stream.head = stream.tail - (len(data) - end)
                del data[end:]
                return data
            if stop >= 0:
                stream.head = stream.tail - (len(data) - stop - len(mark))
                self._past_mark = True
                del data[stop:]
                return data
            stream.head = stream.tail
            if len(data) > MJPEG_FRAME:
                raise RemoteProtocolError(f"a picture of more than {MJPEG_FRAME} bytes")


def _compressed(packet: Packet, quality: int) -> tuple[Buffer, ...]:
    value = packet.value
    if not isinstance(value, Image):
        blocks = packet.blocks
        if not (blocks and is_image(blocks[0] if len(blocks) > 1 else memoryview(blocks[0]))):
            return ()
        try:
            value = Image.from_wire(b"".join(blocks))
        except DecodeError:
            return ()
    try:
        data = jpeg.encode(value, quality)
    except ValueError:
        return ()
    if packet.envelope:
        data = jpeg.commented(data, packet.envelope)
    head = b"Content-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(data)
    return head, data, b"\r\n" + _BOUNDARY


@dataclass(frozen=True, slots=True)
class StreamOptions:
    """The options of a request for pictures; 0: not given. once: one picture, not a stream."""

    once: bool = False
    quality: int = 0
    rate: float = 0.0


def read_stream_options(target: str) -> StreamOptions:
    """The options in `/?action=stream&quality=50&rate=10`. Raises ValueError.

    >>> read_stream_options("/?action=snapshot&quality=50")
    StreamOptions(once=True, quality=50, rate=0.0)
    """
    from urllib.parse import parse_qsl

    from yarpy.carriers.web.http.argument import number_of

    query = target.partition("?")[2]
    found = dict(parse_qsl(query, keep_blank_values=True)) if query.count("&") < 20 else {}
    action = found.get("action", "stream")
    if action not in ("stream", "snapshot"):
        raise ValueError(f"action must be stream or snapshot, not {action[:40]!r}")
    quality = number_of("quality", found, 1, 100)
    if quality != int(quality):
        raise ValueError("quality must be a whole number from 1 to 100")
    return StreamOptions(action == "snapshot", int(quality), number_of("rate", found, 0.001, 1000))
