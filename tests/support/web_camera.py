"""A web camera as they are sold: MJPEG over HTTP, to those who log in if it wants a password.

Rules: digest authentication is computed here from RFC 7616 with the standard library, with nothing
of yarpy; curl, which logs in too, proves it right. A nonce serves once. After an answer, whatever
it was, the camera hangs up.
"""

from __future__ import annotations

import secrets
import socket
import threading
import time
from base64 import b64encode
from collections.abc import Sequence
from contextlib import suppress
from hashlib import md5, sha256
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.request import parse_http_list, parse_keqv_list

import numpy as np

import yarpy
from yarpy.data.sig import jpeg

Y, X = np.mgrid[:48, :64]
PICTURE = yarpy.Image(np.stack([X * 3, Y * 5, X + Y], -1).astype("u1"))
PATH = "mjpg/video.mjpg?camera=1"
CARRIER = f"mjpeg+path.{PATH}"
REALM = 'lab "2", cellar'  # what has to be quoted, and taken apart with care


def is_the_picture(image: yarpy.Image) -> bool:
    difference = image.array.astype(int) - PICTURE.array.astype(int)
    return image.code == "rgb" and float(np.abs(difference).mean()) < 4


class WebCamera(ThreadingHTTPServer):
    """Ten pictures a second at /mjpg/video.mjpg?camera=1, and nothing else.

    login: `name:password`, if it wants one. offers: the ways to log in, each `Basic` or a digest
    algorithm, with `qop` as the digests have it ("": the elder one without).
    """

    daemon_threads = True
    allow_reuse_address = True

    def __init__(
        self, port: int = 0, login: str = "", offers: Sequence[str] = ("Basic",), qop: str = "auth"
    ) -> None:
        super().__init__(("127.0.0.1", port), Show)
        self.login, self.offers, self.qop = login, offers, qop
        self.one_line = False  # all offers in one header
        self.asked: list[str] = []
        self.logins: list[str] = []  # what came as Authorization, "" for nothing
        self.nonces: set[str] = set()
        self.shown: list[socket.socket] = []
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()

    @property
    def name(self) -> str:
        return f"/127.0.0.1:{self.server_port}"

    def leave(self) -> None:
        self.shutdown()
        self.server_close()
        for sock in self.shown:
            with suppress(OSError):
                sock.shutdown(socket.SHUT_RDWR)

    def challenges(self) -> list[str]:
        """What to say to somebody who is not logged in."""
        quoted = REALM.replace('"', '\\"')
        found = []
        for offer in self.offers:
            text = f'Basic realm="{quoted}"'
            if offer != "Basic":
                nonce = secrets.token_hex(12)
                self.nonces.add(nonce)
                text = (
                    f'Digest realm="{quoted}", nonce="{nonce}", opaque="a,b=c", algorithm={offer}'
                )
                text += f', qop="{self.qop}"' * bool(self.qop)
            found.append(text)
        return [", ".join(found)] if self.one_line else found

    def admits(self, given: str, path: str) -> bool:
        """Whether this is the right answer to one of the challenges."""
        scheme, _, rest = given.partition(" ")
        if scheme == "Basic" and "Basic" in self.offers:
            return rest == b64encode(self.login.encode()).decode()
        if scheme != "Digest":
            return False
        said = parse_keqv_list(parse_http_list(rest))
        said = {key: value.replace('\\"', '"') for key, value in said.items()}
        if said.get("algorithm") not in self.offers or said["nonce"] not in self.nonces:
            return False
        self.nonces.remove(said["nonce"])
        user, _, password = self.login.partition(":")
        if (said["username"], said["realm"], said["uri"]) != (user, REALM, path):
            return False
        if said["opaque"] != "a,b=c" or said.get("qop", "") != self.qop.partition(",")[0]:
            return False
        return said["response"] == _response(said, password)


def _response(said: dict[str, str], password: str) -> str:
    algorithm, session, _ = said["algorithm"].partition("-sess")

    def hashed(text: str) -> str:
        return (md5 if algorithm == "MD5" else sha256)(text.encode()).hexdigest()

    first = hashed(f"{said['username']}:{said['realm']}:{password}")
    if session:
        first = hashed(f"{first}:{said['nonce']}:{said['cnonce']}")
    second = hashed(f"GET:{said['uri']}")
    if "qop" not in said:
        return hashed(f"{first}:{said['nonce']}:{second}")
    return hashed(f"{first}:{said['nonce']}:{said['nc']}:{said['cnonce']}:{said['qop']}:{second}")


class Show(BaseHTTPRequestHandler):
    """One request."""

    server: WebCamera

    def do_GET(self) -> None:
        self.server.asked.append(self.path)
        if self.path != f"/{PATH}":
            self.send_error(404)
            return
        login = self.headers["Authorization"] or ""
        self.server.logins.append(login)
        if self.server.login and not self.server.admits(login, self.path):
            self.send_response(401)
            for challenge in self.server.challenges():
                self.send_header("WWW-Authenticate", challenge)
            self.end_headers()
            self.wfile.write(b"<html>Who are you?")
            return
        assert self.headers["Host"] == f"127.0.0.1:{self.server.server_port}"
        self.server.shown.append(self.connection)
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
        self.end_headers()
        data = jpeg.encode(PICTURE)
        try:
            while True:
                self.wfile.write(b"--frame\r\ncontent-length: %d\r\n" % len(data))
                self.wfile.write(b"content-type: image/jpeg\r\n\r\n" + data + b"\r\n")
                time.sleep(0.1)
        except OSError:
            pass

    def log_message(self, *args: object) -> None:
        pass
