"""Pictures to and from programs that know nothing of YARP: a web camera, curl, ffmpeg."""

from __future__ import annotations

import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from support.capture import load_capture
from support.listener import listening
from support.peer import program
from support.port import free_port
from support.process import Process
from support.wait import HANG, wait_until
from support.web_camera import CARRIER, PICTURE, WebCamera, is_the_picture

import yarpy
from yarpy import network
from yarpy.data.sig import jpeg
from yarpy.names.default import secret
from yarpy.port.connect.reconnect import pending


@contextmanager
def viewer(strict: bool = False) -> Iterator[tuple[yarpy.LocalNames, yarpy.BufferedPort]]:
    names = yarpy.LocalNames()
    with yarpy.BufferedPort("/view", strict=strict, names=names) as view:
        yield names, view


def test_camera_is_seen_comes_back_and_is_let_go() -> None:
    with viewer() as (names, view):
        camera = WebCamera()
        name, port = camera.name, camera.server_port
        line = network.connect(name, "/view", CARRIER, names=names).reply
        assert line == f"Added connection from /view to {CARRIER}:/{name}"
        assert is_the_picture(view.read(timeout=HANG).value)
        (link,) = view.inputs
        assert (link.source, link.carrier) == (f"{name}/", CARRIER)
        assert network.is_connected(name, "/view", names=names)
        camera.leave()
        wait_until(lambda: not view.inputs)
        camera = WebCamera(port)
        wait_until(lambda: view.inputs)
        assert is_the_picture(view.read(timeout=HANG).value)
        assert network.disconnect(name, "/view", names=names)
        wait_until(lambda: not view.inputs)
        assert not network.is_connected(name, "/view", names=names)
        count = len(camera.asked)
        time.sleep(1.0)
        assert len(camera.asked) == count, "a connection that somebody ended comes back"
        camera.leave()


@contextmanager
def raw_camera(*answers: bytes) -> Iterator[tuple[str, list[bytes]]]:
    """What sends these bytes, whatever it is asked, to one watcher after the other; its name, and
    what it was asked."""
    asked: list[bytes] = []
    left = list(answers)

    def serve(sock: socket.socket) -> None:
        if left:
            with sock:
                asked.append(sock.recv(1000))
                sock.sendall(left.pop(0))
                sock.settimeout(HANG)
                sock.recv(1)  # until the watcher goes

    with listening(serve) as (port, _):
        yield f"/127.0.0.1:{port}", asked


MULTIPART = b"HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=b\r\n\r\n"


def frame(data: bytes, length: int | None = None, kind: bytes = b"image/jpeg") -> bytes:
    size = b"" if length == -1 else b"Content-Length: %d\r\n" % (length or len(data))
    return b"--b\r\nContent-Type: %s\r\n%s\r\n%s\r\n" % (kind, size, data)


def test_damaged_pictures_are_dropped_and_counted() -> None:
    good = jpeg.encode(PICTURE)
    answer = MULTIPART + b"".join(
        [
            frame(good),
            frame(good[: len(good) // 2]),  # cut off
            frame(b"\0" * 500),  # no picture at all
            frame(b"<html>no signal</html>", kind=b"text/html"),
            frame(good),
            frame(good, length=len(good) - 50),  # longer than it says: broken
            frame(good, length=-1),  # as long as it is
            b"rubbish between\r\n\r\n",
            frame(good),
        ]
    )
    with raw_camera(answer) as (name, asked), viewer(strict=True) as (names, view):
        network.connect(name, "/view", "mjpeg+path.x", names=names)
        for _ in range(4):
            assert is_the_picture(view.read(timeout=HANG).value)
        wait_until(lambda: view.inputs[0].stats.drops == 4)
        assert view.inputs[0].stats.messages == 4
        assert asked[0].startswith(b"GET /x HTTP/1.0\r\n")
        network.disconnect(name, "/view", names=names)


RUDE = [
    (b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n\r\n<html>", "not a stream of pictures"),
    (b"HTTP/1.1 404 Not Found\r\n\r\n", "404 Not Found"),
    (b"what?\r\n\r\n", "what?"),
    (b"HTTP/1.1 200 OK\r\nX: " + b"x" * 100_000, "a line of more than"),
]


@pytest.mark.parametrize(("answer", "reason"), RUDE, ids=["html", "404", "no_http", "large_head"])
def test_what_is_no_camera_is_told(
    answer: bytes, reason: str, caplog: pytest.LogCaptureFixture
) -> None:
    with raw_camera(answer) as (name, _), viewer() as (names, view):
        with pytest.raises(yarpy.LinkClosed, match="Cannot connect"):
            network.connect(name, "/view", "mjpeg", names=names)
        assert reason in caplog.text
        assert not view.inputs


@pytest.mark.parametrize(
    "rest",
    [frame(b"x", length=10**8), b"--b\r\n" + b"X: y\r\n" * 1000, frame(b"x") + b"--b--\r\n"],
    ids=["huge", "headers", "end"],
)
def test_watching_goes_on_after_a_broken_stream(rest: bytes) -> None:
    """The connection ends, the port dials again."""
    good = MULTIPART + frame(jpeg.encode(PICTURE))
    with raw_camera(good + rest, good) as (name, asked), viewer(strict=True) as (names, view):
        network.connect(name, "/view", "mjpeg", names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        wait_until(lambda: len(asked) >= 2)
        assert is_the_picture(view.read(timeout=HANG).value)
        network.disconnect(name, "/view", names=names)


def test_camera_that_went_away_can_be_let_go() -> None:
    with viewer() as (names, view):
        camera = WebCamera()
        network.connect(camera.name, "/view", CARRIER, names=names)
        view.read(timeout=HANG)
        camera.leave()
        wait_until(lambda: not view.inputs)
        network.admin("/view", "del", f"{camera.name}/", names=names)
        camera = WebCamera(camera.server_port)
        time.sleep(1.0)
        assert not camera.asked
        camera.leave()


def test_camera_with_a_name() -> None:
    camera = WebCamera()
    with viewer() as (names, view):
        names.register("/cam", CARRIER, "127.0.0.1", camera.server_port)
        network.connect("/cam", "/view", names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        assert view.inputs[0].source == "/cam"
        assert network.is_connected("/cam", "/view", names=names)
        assert network.disconnect("/cam", "/view", names=names)
        wait_until(lambda: not view.inputs)
    camera.leave()


ASKED_TO_WATCH = [
    "mjpeg_receiver_path_admin_1",
    "mjpeg_receiver_path_admin_2",
    "mjpeg_receiver_default_admin_2",
]


def test_cpp_asks_a_port_to_watch() -> None:
    """The dialogues of C++'s `yarp connect /cam /cap/img` and `yarp disconnect`, byte for byte."""
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/away", names=yarpy.LocalNames()) as camera,
        yarpy.BufferedPort("/cap/img", names=names) as view,
    ):
        names.register("/cam", "mjpeg", camera.contact.host, camera.contact.port)
        for name in ASKED_TO_WATCH:
            if name == "mjpeg_receiver_default_admin_2":
                network.connect("/cam", "/cap/img", names=names)
            where = view.contact.host, view.contact.port
            with socket.create_connection(where, HANG) as sock:
                for step in load_capture(name).steps:
                    if step.sender == "a":
                        sock.sendall(step.data)
                    else:
                        assert sock.recv(len(step.data), socket.MSG_WAITALL) == step.data
            wait_until(lambda name=name: bool(view.inputs) == name.endswith("1"))
            if view.inputs:
                assert camera.wait_for_outputs(timeout=HANG)
                assert camera.write(PICTURE) == 1
                assert is_the_picture(view.read(timeout=HANG).value)


def test_wrong_path_is_told() -> None:
    camera = WebCamera()
    with viewer() as (names, view):
        with pytest.raises(yarpy.LinkClosed, match="Cannot connect"):
            network.connect(camera.name, "/view", "mjpeg+path.wrong", names=names)
        assert not view.inputs
        assert camera.asked == ["/wrong"]
    camera.leave()


# ---------------------------------------------------------------------------------------- browsers


class Browser:
    """A socket that asks for a stream, and reads as it likes."""

    def __init__(self, port: yarpy.Port | yarpy.BufferedPort, options: str = "") -> None:
        self.sock = socket.socket()
        self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)
        self.sock.settimeout(HANG)
        self.sock.connect((port.contact.host, port.contact.port))
        head = f"GET /?action=stream{options} HTTP/1.1\r\nHost: {port.contact.address}\r\n\r\n"
        self.sock.sendall(head.encode())
        self.file = self.sock.makefile("rb")
        assert self.file.readline() == b"HTTP/1.0 200 OK\r\n"
        while self.file.readline().strip():
            pass

    def frame(self) -> bytes:
        assert self.file.readline().startswith(b"--")
        size = 0
        while line := self.file.readline().strip():
            if line.lower().startswith(b"content-length:"):
                size = int(line.split()[1])
        data = self.file.read(size)
        assert self.file.read(2) == b"\r\n"
        return data

    def close(self) -> None:
        self.file.close()
        self.sock.close()


NOISE = yarpy.Image(np.random.default_rng(1).integers(0, 255, (240, 320, 3), "u1"))


@pytest.mark.parametrize("make", [yarpy.Port, yarpy.BufferedPort])
def test_slow_browser_costs_its_port_nothing(make: Callable[..., yarpy.Port]) -> None:
    with make("/cam", names=yarpy.LocalNames()) as port:
        slow, quick = Browser(port), Browser(port)
        wait_until(lambda: len(port.outputs) == 2)
        longest = 0.0
        for number in range(150):
            started = time.perf_counter()
            port.write(NOISE, f"{number} 0.5")
            longest = max(longest, time.perf_counter() - started)
            assert jpeg.comment(quick.frame()) == f"{number} 0.5"
        assert longest < 5
        stalled, free = sorted(port.outputs, key=lambda link: -int(link.stats.replaced))
        assert free.stats.replaced == free.stats.drops == 0
        assert stalled.stats.replaced > 50
        assert stalled.stats.replaced + stalled.stats.messages >= 148
        # What it did not see was not kept for it: a few old pictures, then the newest.
        found: list[str] = []
        while "900 0.5" not in found:
            port.write(NOISE, "900 0.5")
            found.append(jpeg.comment(slow.frame()))
        assert len(found) < 60
        slow.close()
        quick.close()
        wait_until(lambda: not port.outputs)


def test_rate_and_quality() -> None:
    with yarpy.Port("/cam", names=yarpy.LocalNames()) as port:
        browsers = [Browser(port), Browser(port, "&quality=10"), Browser(port, "&rate=10")]
        wait_until(lambda: len(port.outputs) == 3)
        sizes: list[list[int]] = [[], [], []]

        def look(index: int) -> None:
            try:
                while True:
                    sizes[index].append(len(browsers[index].frame()))
            except (OSError, AssertionError, ValueError):
                pass

        threads = [threading.Thread(target=look, args=(index,)) for index in range(3)]
        for thread in threads:
            thread.start()
        started = time.monotonic()

        def slow() -> bool:
            """Return whether there is one that hears a tenth of a second apart, and others more."""
            port.write(NOISE)
            fewest, *_, most = sorted(int(link.stats.messages) for link in port.outputs)
            assert fewest <= 10 * (time.monotonic() - started) + 2
            return fewest > 8 and most > fewest + 8

        wait_until(slow)
    for thread in threads:
        thread.join(HANG)
    for browser in browsers:
        browser.close()
    assert sizes[1][0] < sizes[0][0] / 2


def test_port_that_shows_something_else_counts_it() -> None:
    with yarpy.Port("/cam", names=yarpy.LocalNames()) as port:
        browser = Browser(port)
        wait_until(lambda: port.outputs)
        assert port.write([1, "no picture"]) == 0
        assert port.write(PICTURE) == 1
        assert browser.frame()
        assert port.outputs[0].stats.drops == 1
        browser.close()


def test_pictures_between_two_ports_with_their_stamps() -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/cam", names=names) as cam, yarpy.Port("/view", names=names) as view:
        network.connect("/cam", "/view", "mjpeg+quality.95", names=names)
        assert cam.wait_for_outputs(timeout=HANG)
        assert cam.outputs[0].carrier == "mjpeg+quality.95"
        cam.write(PICTURE, yarpy.Stamp(7, 1.5))
        message = view.read(timeout=HANG)
        assert is_the_picture(message.value)
        assert message.stamp == yarpy.Stamp(7, 1.5)


# -------------------------------------------------------------------------------------- programs


def test_camera_knows_nothing_of_our_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With an auth.conf ports prove to each other that they know it; a camera need not."""
    (tmp_path / "auth.conf").write_text('[AUTH]\nkey "our secret"\n')
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    assert secret()
    with viewer() as (names, view), yarpy.Port("/cam", names=names) as cam:
        camera = WebCamera()
        network.connect(camera.name, "/view", CARRIER, names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        assert network.disconnect(camera.name, "/view", names=names)
        camera.leave()
        network.connect("/cam", "/view", "mjpeg", names=names)  # which has the key
        assert cam.wait_for_outputs(timeout=HANG)
        cam.write(PICTURE)
        assert is_the_picture(view.read(timeout=HANG).value)


@pytest.mark.peer("curl")
def test_curl_watches() -> None:
    with yarpy.Port("/cam", names=yarpy.LocalNames()) as port:
        url = f"http://127.0.0.1:{port.contact.port}/?action=stream"
        with subprocess.Popen(
            [program("curl"), "-sN", "-m", "20", url], stdout=subprocess.PIPE
        ) as process:
            assert process.stdout is not None
            assert port.wait_for_outputs(timeout=HANG)
            for count in range(3):  # one that is on its way is replaced by the next one
                port.write(PICTURE)
                wait_until(lambda: port.outputs[0].stats.messages > count)  # noqa: B023
            data = jpeg.encode(PICTURE)
            head = b"--boundarydonotcross\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
            whole = (head % len(data) + data + b"\r\n") * 3
            assert process.stdout.read(len(whole)) == whole
            process.kill()
        wait_until(lambda: not port.outputs)
        assert not pending(port._hub)


@pytest.mark.peer("ffmpeg")
def test_ffmpeg_is_a_camera() -> None:
    number = free_port()
    source = ["-f", "lavfi", "-re", "-i", "testsrc=size=64x48:rate=20", "-f", "mpjpeg"]
    where = f"http://127.0.0.1:{number}/video"
    args = [program("ffmpeg"), "-loglevel", "error", *source, "-listen", "1", where]
    with viewer() as (names, view), Process(args):
        address = f"/127.0.0.1:{number}"
        network.connect(address, "/view", "mjpeg+path.video", names=names, timeout=HANG)
        image = view.read(timeout=HANG).value
        assert (image.width, image.height, image.code) == (64, 48, "rgb")


@pytest.mark.peer("ffmpeg")
def test_ffmpeg_watches() -> None:
    with yarpy.Port("/cam", names=yarpy.LocalNames()) as port:
        url = f"http://127.0.0.1:{port.contact.port}/?action=stream"
        to = ["-frames:v", "3", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        args = [program("ffmpeg"), "-loglevel", "error", "-f", "mpjpeg", "-i", url, *to]
        with subprocess.Popen(args, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None
            deadline = time.monotonic() + HANG
            while process.poll() is None and time.monotonic() < deadline:
                port.write(PICTURE)
                time.sleep(0.02)
            frames = process.stdout.read()
            process.kill()
        assert len(frames) == 3 * 64 * 48 * 3
