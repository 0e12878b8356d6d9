"""An image port that shows what comes: counts, what is no picture, what eyes cannot see."""

from __future__ import annotations

import http.client
import socket
import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.sig import jpeg
from yarpy.kits.views.picture import Missing, Picture, visible

RED = yarpy.Image(np.full((24, 32, 3), (200, 20, 20), "u1"))


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def picture(names: yarpy.LocalNames) -> Iterator[Picture]:
    with yarpy.BufferedPort("/view", names=names) as port:
        yield Picture(port)


@pytest.fixture
def camera(names: yarpy.LocalNames, picture: Picture) -> Iterator[yarpy.Port]:
    with yarpy.Port("/cam", names=names) as port:
        port.connect("/view")
        assert picture.port.wait_for_inputs(timeout=HANG)
        yield port


ALL = ("frames", "replaced", "drops")


def arrived(picture: Picture, count: int) -> None:
    wait_until(lambda: picture.status()["frames"] == count)


def test_what_is_told(picture: Picture, camera: yarpy.Port) -> None:
    told = picture.status()
    assert (told["name"], told["frames"], told["rate"], told["age"]) == ("/view", 0, 0.0, None)
    assert told["sources"] == [{"name": "/cam", "carrier": "tcp"}]
    for number in range(1, 4):
        camera.write(RED)
        arrived(picture, number)
    told = picture.status()
    assert (told["width"], told["height"], told["pixel"], told["range"]) == (32, 24, "rgb", None)
    assert told["rate"] > 0
    assert 0 <= told["age"] < HANG
    assert (told["replaced"], told["drops"], told["others"]) == (0, 0, 0)
    assert told["complaint"] == ""
    picture.wait_for("for the sun")
    assert picture.status()["waiting"] == "for the sun"


def test_what_is_no_picture_is_counted_and_the_port_lives(
    picture: Picture, camera: yarpy.Port
) -> None:
    for value, complaint in (
        (["hello", 1], "/cam: hello 1"),
        (yarpy.Sound(np.zeros((1, 4), "i2")), "/cam: 48 bytes that are not a picture"),
        (["x" * 200], f"/cam: {'x' * 80}..."),
        (yarpy.Image(np.zeros((0, 4), "u1")), "/cam: a picture without pixels"),
        (yarpy.Image(np.zeros((4, 4), "u1"), "yuva"), "/cam: pictures of pixels 'yuva' cannot "),
    ):
        before = picture.status()["others"]
        camera.write(value)
        wait_until(lambda before=before: picture.status()["others"] == before + 1)
        assert picture.status()["complaint"].startswith(complaint)
    camera.write(RED)
    arrived(picture, 1)
    assert picture.status()["others"] == 5


def test_who_comes_late_sees_the_last_picture(picture: Picture, camera: yarpy.Port) -> None:
    camera.write(RED, yarpy.Stamp(7, 1.5))
    arrived(picture, 1)
    for _ in range(2):
        connection = http.client.HTTPConnection(picture.port.address, timeout=HANG)
        connection.request("GET", "/?action=stream")
        response = connection.getresponse()
        lines = [response.readline() for _ in range(4)]
        data = response.read(int(lines[2].split()[1]))
        assert jpeg.comment(data) == "7 1.5"
        image = yarpy.Image.from_wire(jpeg.decode(data))
        assert np.abs(image.array.astype(int) - RED.array).max() < 10
        connection.close()


def test_damaged_pictures_of_a_camera_are_counted(picture: Picture, names: Any) -> None:
    whole = jpeg.encode(RED)
    damaged = whole.replace(b"\xff\xda", b"zz")
    part = b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n%s\r\n"
    body = b"".join(part % (len(data), data) for data in (whole, damaged, whole[:-40], whole))
    with socket.create_server(("127.0.0.1", 0)) as listening:

        def film() -> None:
            sock, _ = listening.accept()
            with sock:
                sock.recv(1000)
                head = (
                    b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=x\r\n\r\n"
                )
                sock.sendall(head + body)
                done.wait(HANG)

        done = threading.Event()
        thread = threading.Thread(target=film)
        thread.start()
        picture.port.listen_to(f"/127.0.0.1:{listening.getsockname()[1]}", "mjpeg")
        wait_until(lambda: sum(picture.status()[key] for key in ALL) >= 4)
        told = picture.status()
        assert told["drops"] == 2  # of the others the first may not have been looked at in time
        assert sum(told[key] for key in ALL) == 4
        assert (told["others"], told["complaint"]) == (0, "")
        done.set()
        thread.join(HANG)


def test_what_is_missing_of_connections_that_have_gone() -> None:
    class Link:
        def __init__(self, since: float, drops: int) -> None:
            self.source = "/cam"
            self.stats = SimpleNamespace(since=since, drops=1, replaced=drops - 1)

    class Port:
        inputs: list[Link]

    port, missing = Port(), Missing()
    for links, total, lost in (
        ([Link(1.0, 2)], 2, 1),
        ([Link(1.0, 5)], 5, 1),
        ([], 5, 1),
        ([], 5, 1),
        ([Link(2.0, 1)], 6, 2),
        ([Link(2.0, 1), Link(3.0, 10)], 16, 3),
        ([Link(3.0, 11)], 17, 3),
    ):
        port.inputs = links
        replaced, drops = missing.count(port)  # type: ignore[arg-type]
        assert (replaced + drops, drops) == (total, lost)


DEPTH = np.array([[0.5, 1.5], [np.nan, 2.5]], "f4")


@pytest.mark.parametrize(
    ("array", "code", "expected", "span"),
    [
        (DEPTH, "dec", [[0, 127], [0, 255]], (0.5, 2.5)),
        (np.full((1, 2), np.nan, "f4"), "dec", [[0, 0]], (0.0, 0.0)),
        (np.full((1, 2), np.inf, "f4"), "dec", [[0, 0]], (0.0, 0.0)),
        (np.array([[1000, 2000, 3000]], "u2"), "mo16", [[0, 127, 255]], (1000.0, 3000.0)),
        (np.array([[-5, 5]], "i4"), "int", [[0, 255]], (-5.0, 5.0)),
        (np.array([[7, 7]], "u2"), "mo16", [[0, 0]], (7.0, 7.0)),
        (np.array([[-128, 127]], "i1"), "sign", [[0, 255]], None),
        (np.array([[3, 4]], "u1"), "grbg", [[3, 4]], None),
        (np.array([[300, 301]], "u2"), "gr16", [[0, 255]], (300.0, 301.0)),
    ],
)
def test_what_is_stretched(
    array: np.ndarray, code: str, expected: list[list[int]], span: tuple[float, float] | None
) -> None:
    shown, found = visible(yarpy.Image(array, code))
    assert (shown.code, found) == ("mono", span)
    assert np.abs(shown.array.astype(int) - expected).max() <= 1


@pytest.mark.parametrize("code", ["mono", "rgb", "bgr", "rgba", "bgra"])
def test_what_is_seen_as_it_is(code: str) -> None:
    image = RED.converted(code)
    assert visible(image) == (image, None)


def test_colours_of_other_numbers() -> None:
    shown, span = visible(yarpy.Image(np.full((2, 2, 3), 100, "i4"), "rgbi"))
    assert (shown.code, span) == ("rgb", None)
    assert (shown.array == 100).all()
