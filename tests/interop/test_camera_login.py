"""Cameras that want a name and a password, as a camera, curl and the command line see it."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.peer import program
from support.wait import HANG, wait_until
from support.web_camera import CARRIER, PATH, WebCamera, is_the_picture

import yarpy
from yarpy import network
from yarpy.port.connect import reconnect

LOGIN = 'me "x":se+cret%'  # what has to be quoted in the carrier string, and for the camera
WORDS = "+user.me%20%22x%22+password.se%2Bcret%25"
DIGESTS = ["MD5", "MD5-sess", "SHA-256", "SHA-256-sess"]


@contextmanager
def camera(
    *offers: str, port: int = 0, qop: str = "auth", login: str = LOGIN
) -> Iterator[WebCamera]:
    server = WebCamera(port, login, offers, qop)
    try:
        yield server
    finally:
        server.leave()


@pytest.fixture
def view(names: yarpy.LocalNames) -> Iterator[yarpy.BufferedPort]:
    with yarpy.BufferedPort("/view", names=names) as port:
        yield port


@pytest.mark.peer("curl")
@pytest.mark.parametrize("algorithm", DIGESTS)
def test_curl_logs_in(algorithm: str) -> None:
    """So the camera of these tests speaks what others speak."""
    curl = program("curl")
    with camera(algorithm) as server:
        with subprocess.Popen(
            [curl, "-sN", "-m", "20", "--digest", "-u", LOGIN, f"http:/{server.name}/{PATH}"],
            stdout=subprocess.PIPE,
        ) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == b"--frame\r\n"
            process.kill()
        assert server.logins[-1].startswith("Digest ")
        wrong = [curl, "-s", "-m", "20", "-w", "%{http_code}", "--digest", "-u", "me:no"]
        said = subprocess.run(
            [*wrong, f"http:/{server.name}/{PATH}"], capture_output=True, timeout=30
        )
        assert said.stdout.endswith(b"401")


@pytest.mark.parametrize("qop", ["auth", "auth,auth-int", ""])
@pytest.mark.parametrize("algorithm", DIGESTS)
def test_digest(
    algorithm: str, qop: str, names: yarpy.LocalNames, view: yarpy.BufferedPort
) -> None:
    with camera(algorithm, qop=qop) as server:
        line = network.connect(server.name, "/view", CARRIER + WORDS, names=names).reply
        assert is_the_picture(view.read(timeout=HANG).value)
        assert server.logins[0] == ""
        assert server.logins[1].startswith("Digest ")
        assert len(server.logins) == 2
        shown = f"{CARRIER}+user.me%20%22x%22+password.***"
        assert view.inputs[0].carrier == shown
        assert line == f"Added connection from /view to {shown}:/{server.name}"
        assert network.is_connected(server.name, "/view", CARRIER + WORDS, names=names)
        assert network.disconnect(server.name, "/view", names=names)


@pytest.mark.parametrize("one_line", [False, True])
@pytest.mark.parametrize(
    ("offers", "chosen"),
    [
        (["MD5", "SHA-256"], "SHA-256"),
        (["Basic", "SHA-512-256", "MD5-sess", "SHA-256-sess"], "SHA-256-sess"),
        (["Basic", "MD5"], "MD5"),
        (["Basic"], "Basic"),
    ],
)
def test_the_best_of_several_is_chosen(
    offers: list[str],
    chosen: str,
    one_line: bool,
    names: yarpy.LocalNames,
    view: yarpy.BufferedPort,
) -> None:
    with camera(*offers) as server:
        server.one_line = one_line
        network.connect(server.name, "/view", CARRIER + WORDS, names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        first, second = server.logins
        assert first == ""
        assert second.startswith("Basic ") if chosen == "Basic" else f"={chosen}," in second
        network.disconnect(server.name, "/view", names=names)


def test_camera_that_is_open_is_told_nothing(
    names: yarpy.LocalNames, view: yarpy.BufferedPort
) -> None:
    with camera(login="") as server:
        network.connect(server.name, "/view", CARRIER + WORDS, names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        assert server.logins == [""]
        network.disconnect(server.name, "/view", names=names)


@pytest.mark.parametrize("offer", ["Basic", "SHA-256"])
def test_camera_that_comes_back_is_logged_in_at_again(
    offer: str,
    names: yarpy.LocalNames,
    view: yarpy.BufferedPort,
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level("DEBUG")
    with camera(offer) as server:
        network.connect(server.name, "/view", CARRIER + WORDS, names=names)
        assert is_the_picture(view.read(timeout=HANG).value)
        for question in (["list", "in", f"{server.name}/"], ["list", "in"]):
            assert "se%2B" not in str(network.admin("/view", *question, names=names))
        number = server.server_port
    wait_until(lambda: not view.inputs)
    with camera(offer, port=number) as server:
        wait_until(lambda: view.inputs)
        assert is_the_picture(view.read(timeout=HANG).value)
        assert server.logins[-1].startswith(offer if offer == "Basic" else "Digest")
        network.disconnect(server.name, "/view", names=names)
    assert "se%2Bcret" not in caplog.text
    assert "se+cret" not in caplog.text


def test_password_that_was_changed_is_not_tried_again_and_again(
    names: yarpy.LocalNames,
    view: yarpy.BufferedPort,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Cameras lock those out who do. A minute later is soon enough; here it is an hour."""
    monkeypatch.setattr(reconnect, "LOCKED", 3600.0)
    with camera("MD5") as server:
        network.connect(server.name, "/view", CARRIER + WORDS, names=names)
        view.read(timeout=HANG)
        server.login = "me:another"
        for sock in server.shown:
            sock.shutdown(socket.SHUT_RDWR)
        wait_until(lambda: "it is asked again every 3600 s" in caplog.text)
        assert "does not accept this name and password" in caplog.text
        count = len(server.logins)
        with pytest.raises(AssertionError):
            wait_until(lambda: len(server.logins) > count, 2.0)
        # Who connects it anew need not wait.
        words = f"{CARRIER}+user.me+password.another"
        network.connect(server.name, "/view", words, names=names)
        wait_until(lambda: view.inputs)
        network.disconnect(server.name, "/view", names=names)


@pytest.mark.parametrize("offer", ["Basic", "MD5"])
def test_wrong_password_is_told_at_once(
    offer: str,
    names: yarpy.LocalNames,
    view: yarpy.BufferedPort,
    caplog: pytest.LogCaptureFixture,
) -> None:
    words = f"{CARRIER}+user.me+password.wr0ng"
    with camera(offer) as server:
        with pytest.raises(yarpy.LoginRefused, match="does not accept this name") as caught:
            network.connect(server.name, "/view", words, names=names, timeout=HANG)
        assert len(server.logins) == 2
        with pytest.raises(yarpy.LoginRefused, match='"/view" is not admitted to') as direct:
            view.listen_to(server.name, words)
        assert len(server.logins) == 4
        with pytest.raises(yarpy.LoginRefused):
            view.connect(server.name, words, timeout=HANG)
        assert len(server.logins) == 6
        assert not view.inputs
    for text in (str(caught.value), str(direct.value), caplog.text):
        assert "wr0ng" not in text


def test_other_refusals_are_told(names: yarpy.LocalNames, view: yarpy.BufferedPort) -> None:
    with camera("SHA-512-256", "Basic") as server:
        with pytest.raises(yarpy.LoginRefused, match="wants a name and a password"):
            network.connect(server.name, "/view", CARRIER, names=names)
        with pytest.raises(yarpy.LoginRefused, match="SHA-512-256, which yarpy does not support"):
            network.connect(server.name, "/view", CARRIER + WORDS, names=names)
        assert server.logins == ["", ""]
        with pytest.raises(yarpy.LinkClosed, match=r"404.*\+path"):
            network.connect(server.name, "/view", "mjpeg+path.wrong", names=names)


def test_command_line_says_what_to_do(tmp_path: Path) -> None:
    with (
        yarpy.NameServer() as server,
        yarpy.BufferedPort("/view") as view,
        camera("SHA-256") as web,
    ):
        cli = CommandLine(tmp_path, server.environment)
        said = cli.run("connect", web.name, "/view", f"{CARRIER}+user.me+password.wr0ng")
        assert said.returncode == 1
        assert "does not accept this name and password: check both" in said.stderr
        assert said.stderr.count("\n") == 1
        assert "wr0ng" not in said.stdout + said.stderr
        said = cli.run("connect", web.name, "/view", CARRIER)
        assert "+user.<name>+password.<word>" in said.stderr
        said = cli.run("connect", web.name, "/view", CARRIER + WORDS)
        assert (said.returncode, said.stderr) == (0, "")
        assert "password.***" in said.stdout
        assert is_the_picture(view.read(timeout=HANG).value)
        file = tmp_path / "wires.ini"
        file.write_text(f'[cam]\nfrom "{web.name}"\nto /view\ncarrier "{CARRIER}{WORDS}"\n')
        said = cli.run("connect", "--file", str(file))
        assert (said.returncode, said.stderr) == (0, "")
        assert "password.***" in said.stdout
        assert cli.run("disconnect", web.name, "/view").returncode == 0


def test_viewer_with_a_wrong_password_ends(tmp_path: Path) -> None:
    with yarpy.NameServer() as server, camera("MD5") as web:
        cli = CommandLine(tmp_path, server.environment)
        source = f"{CARRIER}+user.me+password.wr0ng:/{web.name}/"
        said = cli.run("view", "--no-browser", "--connect", source)
        assert said.returncode == 1
        assert "does not accept this name and password" in said.stderr
        assert "wr0ng" not in said.stdout + said.stderr
        assert len(web.logins) == 2
