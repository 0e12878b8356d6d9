"""The server of a page: HTTP for the page and what it asks, a WebSocket for what is played.

    GET /             the page           GET /timeline     ports, gaps and marks, as JSON
    GET /curve        ?port=&begin=&end=&points=           the numbers of a port, as JSON
    GET /log          ?port=&end=                          the lines of a log until then, as JSON
    GET /attached     ?name=                               a file that the recording was given
    GET /data.csv     ?port=&begin=&end=                   all of them as a file
    GET /cut.mcap     ?begin=&end=                         a stretch of time as a recording
    GET / with Upgrade: websocket                          the protocol of Foxglove

Of two recordings `offset`, in each question, tells how many seconds the second one begins after the
first one.

Rules: begin and end are seconds from `origin`, in nanoseconds: the beginning of the recording
unless another one is given, since that of what is live goes on. It is the page of this computer
unless it is told otherwise, and the origin rule is that of all pages of programs
(`YARPY_WEB_ORIGINS`). Requests have a size and a time, connections a number (`limited_server`).
Nothing that is asked here changes anything.
"""

from __future__ import annotations

import json
import shutil
import socket
import struct
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from http.server import BaseHTTPRequestHandler
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, Self
from urllib.parse import parse_qs, urlsplit

from yarpy.carriers.web.http import asset
from yarpy.carriers.web.http.origin import may_not_act, not_ours, origins_of
from yarpy.errors import DecodeError, Timeout, YarpError
from yarpy.kits.record.convert import convert
from yarpy.kits.record.view.curve import as_csv, curves
from yarpy.kits.record.view.foxglove import PORT, PROTOCOLS, status
from yarpy.kits.record.view.limited_server import LimitedServer
from yarpy.kits.record.view.log import lines_before
from yarpy.kits.record.view.overview import SECOND
from yarpy.kits.record.view.session import Session
from yarpy.kits.record.view.source import Source
from yarpy.limit import VIEW_ORDER, VIEW_SECONDS
from yarpy.log import logger

log = logger("yarpy.view")

_KINDS: Final = {"html": "text/html", "css": "text/css", "js": "text/javascript"}
_PARTS: Final = ("beside", "card", "cloud", "link", "sound", "time")
_FILES: Final = frozenset(
    ["look.html", "look.css", "look.js", *(f"look_{part}.js" for part in _PARTS)]
)
_SENDING: Final = struct.pack("ll", int(VIEW_SECONDS), 0)
_PIECE: Final = 1 << 20  # bytes of a file that are taken within VIEW_SECONDS


class View:
    """Serves `source` until `close`. host: "" for all addresses. port: None for the one that
    Foxglove looks for, or another where that is taken. Raises OSError."""

    def __init__(self, source: Source, host: str = "127.0.0.1", port: int | None = None) -> None:
        self.source = source
        self.sessions: set[Session] = set()
        self._cutting = threading.Lock()  # one at a time
        handler = type("Handler", (_Handler,), {"view": self})
        try:
            self._server = LimitedServer((host, PORT if port is None else port), handler)
        except OSError:
            if port is not None:
                raise
            self._server = LimitedServer((host, 0), handler)
        self._thread = threading.Thread(
            target=self._server.serve_forever, args=(0.1,), name="yarpy view", daemon=True
        )
        self._thread.start()

    @property
    def url(self) -> str:
        """Return where the page is."""
        host, port = self._server.server_address[:2]
        return f"http://{'127.0.0.1' if host in ('', '0.0.0.0') else host!s}:{port}/"

    def close(self) -> None:
        """Close all connections."""
        self._server.shutdown()
        for session in list(self.sessions):
            session.close()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    # -- what is asked ----------------------------------------------------------------------------

    def of(self, fields: Mapping[str, str]) -> Source:
        """Return what is asked about. Raises ValueError."""
        return self.source.at(float(fields["offset"])) if "offset" in fields else self.source

    def stretch(self, fields: Mapping[str, str]) -> tuple[int, int]:
        """Return the moments that are asked for, in nanoseconds. Raises ValueError."""
        origin, source = self.origin(fields), self.of(fields)
        begin, end = (float(fields[key]) if key in fields else None for key in ("begin", "end"))
        first = source.begin if begin is None else origin + round(begin * SECOND)
        last = source.end + 1 if end is None else origin + round(end * SECOND)
        return max(0, first), min(max(0, last), 1 << 62)

    def origin(self, fields: Mapping[str, str]) -> int:
        """Return the moment from which seconds are counted. Raises ValueError."""
        return int(fields.get("origin") or self.of(fields).begin)

    def known(self, fields: Mapping[str, str]) -> str:
        """Return the port that is asked for. Raises KeyError."""
        port = fields["port"]
        if port not in self.source.kinds:
            raise KeyError(port)
        return port

    def curve(self, fields: Mapping[str, str]) -> dict[str, Any]:
        """Return the numbers of a port."""
        begin, end = self.stretch(fields)
        points = int(fields.get("points", "1000"))
        with self.of(fields).open() as recording:
            return curves(recording, self.known(fields), self.origin(fields), begin, end, points)

    def lines(self, fields: Mapping[str, str]) -> list[dict[str, Any]]:
        """Return the last lines of a log before the end of a stretch."""
        _, end = self.stretch(fields)
        with self.of(fields).open() as recording:
            return lines_before(recording, self.known(fields), self.origin(fields), end)

    def csv(self, fields: Mapping[str, str]) -> Iterator[bytes]:
        """Yield the lines of a file."""
        with self.of(fields).open() as recording:
            yield from as_csv(recording, self.known(fields), *self.stretch(fields))

    def cut(self, fields: Mapping[str, str], write: Callable[[Path], object]) -> None:
        """Call `write` with a recording of a stretch of time, which goes again."""
        begin, end = self.stretch(fields)
        if not self._cutting.acquire(timeout=VIEW_SECONDS):
            raise Timeout("another stretch is being cut out: ask again when it has arrived")
        try:
            self._cut(self.of(fields), begin, end, write)
        finally:
            self._cutting.release()

    def _cut(self, source: Source, begin: int, end: int, write: Callable[[Path], object]) -> None:
        with (
            tempfile.TemporaryDirectory(prefix="yarpy-cut-") as folder,
            source.open() as recording,
        ):
            first = min((storage.begin for storage in recording.storages if storage.end), default=0)
            start, duration = (begin - first) / SECOND, max(0, end - begin) / SECOND
            ports = [*source.kinds]
            done = convert(
                recording, Path(folder) / "cut", ports=ports, start=start, duration=duration
            )
            write(done.path)


@cache
def _file(name: str) -> bytes:
    return files("yarpy.kits.record.view").joinpath("assets", name).read_bytes()


class _Handler(BaseHTTPRequestHandler):
    """A connection."""

    view: View
    server: LimitedServer
    protocol_version = "HTTP/1.1"
    server_version = "yarpy"
    sys_version = ""
    timeout = VIEW_SECONDS

    def log_message(self, format: str, *words: Any) -> None:
        log.debug(format, *words)

    def do_GET(self) -> None:
        """Answer."""
        self.server.has_come(self.connection)
        headers = {key.lower(): value for key, value in self.headers.items()}
        origins = origins_of()
        if origins.turns_away(headers, self.connection.getsockname()[0]):
            return self._say(not_ours(headers.get("host", "")), 421)
        if not origins.shows(headers):
            return self._say(may_not_act(origins, headers), 403)
        parts = urlsplit(self.path)
        fields = {key: values[-1] for key, values in parse_qs(parts.query).items()}
        if headers.get("upgrade", "").lower() == "websocket":
            try:
                source = self.view.of(fields)
            except ValueError as error:
                return self._say(str(error), 400)
            return self._talk(source)
        try:
            self._answer(parts.path, fields)
        except KeyError as error:
            self._say(f"there is no {error}", 404)
        except (ValueError, OverflowError) as error:
            self._say(str(error), 400)
        except Timeout as error:
            self._say(str(error), 503)
        except YarpError as error:
            self._say(str(error), 500)

    def handle_one_request(self) -> None:
        """Read a request, which has to come in time, and answer it."""
        self.server.expect(self.connection)
        super().handle_one_request()

    def _answer(self, path: str, fields: Mapping[str, str]) -> None:
        view, name = self.view, "look.html" if path == "/" else path[1:]
        if path == "/timeline":
            self._send(json.dumps(view.of(fields).told()).encode(), "application/json")
        elif path == "/curve":
            self._send(json.dumps(view.curve(fields)).encode(), "application/json")
        elif path == "/log":
            self._send(json.dumps(view.lines(fields)).encode(), "application/json")
        elif path == "/attached":
            content = view.source.attachment(fields["name"])
            self._send(content, "application/octet-stream")
        elif path == "/data.csv":
            view.known(fields)
            view.stretch(fields)
            self._stream(view.csv(fields), "text/csv; charset=utf-8")
        elif path == "/cut.mcap":
            view.cut(fields, self._send_file)
        elif path == "/favicon.ico":  # which browsers ask for unasked
            self._send(b"", "image/x-icon")
        elif name in _FILES:
            self._send(_file(name), f"{_KINDS[name.rpartition('.')[2]]}; charset=utf-8")
        elif name.startswith(asset.PREFIX) and name[len(asset.PREFIX) :] in asset.KINDS:
            name = name[len(asset.PREFIX) :]
            self._send(asset.asset(name).encode(), asset.KINDS[name])
        else:
            self._say("there is no such page", 404)

    def _head(self, kind: str, length: int | None, code: int = 200) -> None:
        self.send_response(code)
        self.send_header("Content-Type", kind)
        if length is not None:
            self.send_header("Content-Length", str(length))
        else:
            self.send_header("Connection", "close")
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Content-Security-Policy", "frame-ancestors 'self'")
        self.end_headers()

    def _send(self, body: bytes, kind: str, code: int = 200) -> None:
        self._head(kind, len(body), code)
        self.wfile.write(body)

    def _say(self, text: str, code: int) -> None:
        self._send(f"{text}\n".encode(), "text/plain; charset=utf-8", code)

    def _stream(self, pieces: Iterator[bytes], kind: str) -> None:
        self._head(kind, None)
        self.close_connection = True
        for piece in pieces:
            self.wfile.write(piece)

    def _send_file(self, path: Path) -> None:
        self._head("application/octet-stream", path.stat().st_size)
        with path.open("rb") as file:
            shutil.copyfileobj(file, self.wfile, _PIECE)

    # -- the WebSocket ----------------------------------------------------------------------------

    def _talk(self, source: Source) -> None:
        from wsproto import ConnectionType, WSConnection
        from wsproto.events import (
            AcceptConnection,
            BytesMessage,
            CloseConnection,
            Ping,
            Request,
            TextMessage,
        )
        from wsproto.utilities import LocalProtocolError, RemoteProtocolError

        self.close_connection = True
        line, talk = self.connection, WSConnection(ConnectionType.SERVER)
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        line.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, _SENDING)
        line.settimeout(None)
        lock = threading.Lock()  # of what is sent: two threads do

        def put(event: Any) -> None:
            with lock:
                try:
                    data = talk.send(event)
                except LocalProtocolError as error:  # it has said goodbye
                    raise ConnectionError(str(error)) from error
                line.sendall(data)

        def send(what: bytes | dict[str, Any]) -> None:
            if isinstance(what, bytes):
                put(BytesMessage(what))
            else:
                put(TextMessage(json.dumps(what)))

        session = Session(source, send)
        sending = threading.Thread(
            target=self._serve, args=(session,), name="yarpy view client", daemon=True
        )
        heard: list[Any] = []
        size = 0  # of what was heard, in which a frame counts, too
        try:
            named = [(key.encode(), value.encode("latin-1")) for key, value in self.headers.items()]
            talk.initiate_upgrade_connection(named, self.path)
            while True:
                for event in talk.events():
                    if isinstance(event, Request):
                        known = [one for one in PROTOCOLS if one in event.subprotocols]
                        put(AcceptConnection(subprotocol=known[0] if known else None))
                        self.view.sessions.add(session)
                        sending.start()
                    elif isinstance(event, TextMessage | BytesMessage):
                        heard.append(event.data)
                        size += len(event.data) + 1
                        if size > VIEW_ORDER:
                            put(CloseConnection(1009))
                            return
                        if event.message_finished:
                            self._hear(session, heard, send)
                            heard, size = [], 0
                    elif isinstance(event, Ping):
                        put(event.response())
                    elif isinstance(event, CloseConnection):
                        put(event.response())
                        return
                data = line.recv(1 << 16)
                talk.receive_data(data or None)
        except (OSError, RemoteProtocolError):
            log.debug("a page has gone", exc_info=True)
        finally:
            session.close()
            self.view.sessions.discard(session)

    def _serve(self, session: Session) -> None:
        try:
            session.run()
        except (OSError, YarpError):
            log.debug("a page is served no more", exc_info=True)
        with suppress(OSError):
            self.connection.shutdown(socket.SHUT_RDWR)

    def _hear(
        self, session: Session, heard: list[Any], send: Callable[[dict[str, Any]], None]
    ) -> None:
        try:
            if isinstance(heard[0], str):
                answer = session.hear_text("".join(heard))
            else:
                answer = session.hear_bytes(b"".join(map(bytes, heard)))
        except DecodeError as error:
            answer = status(str(error), 2)
        if answer is not None:
            send(answer)
