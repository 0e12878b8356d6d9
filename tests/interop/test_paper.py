"""What the paper on YARP promises to cameras, web pages and people: with ffmpeg, curl and netcat.

Sections 5, 7 and 8 of "A middle way for robotics middleware" (2014), line by line: a webcam, the
head of an iCub, its camera, and somebody who types.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest
from support.peer import program
from support.port import free_port
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.sig import jpeg

HEAD = "/icubSim/head/rpc:i"


@pytest.fixture(scope="module")
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        yield server


@pytest.fixture
def head(server: yarpy.NameServer) -> Iterator[yarpy.RpcServer]:
    """A controller of six joints."""
    angles = [-0.000031, 0.0, -0.0, 0.0, 0.0, -0.0]

    def answer(message: yarpy.Message) -> object:
        match message.value:
            case ["set", "pos", int(axis), angle]:
                angles[axis] = float(angle)
                return [yarpy.Vocab("ok")]
            case ["get", "encs"]:
                return [yarpy.Vocab("is"), yarpy.Vocab("encs"), angles, yarpy.Vocab("ok")]
        return [yarpy.Vocab("fail")]

    with yarpy.RpcServer(HEAD, answer) as port:
        yield port


def run(name: str, *args: str, said: str = "") -> str:
    done = subprocess.run(
        [program(name), *args],
        input=said.encode(),
        capture_output=True,
        timeout=HANG,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.decode()


def curl(*args: str) -> str:
    return run("curl", "-sS", "--noproxy", "*", "-m", "20", *args)


# ------------------------------------------------------------------------------------ 5: a camera


@pytest.mark.peer("ffmpeg")
def test_camera_of_the_network_goes_straight_into_a_port(server: yarpy.NameServer) -> None:
    """`yarp connect /67.52.88.202:5159 /view mjpeg+path.mjpg/video.mjpg?camera=1`"""
    number, path = free_port(), "mjpg/video.mjpg?camera=1"
    source = ["-f", "lavfi", "-re", "-i", "testsrc=size=64x48:rate=20", "-f", "mpjpeg"]
    camera = [program("ffmpeg"), "-loglevel", "error", *source, "-listen", "1"]
    connect = [sys.executable, "-m", "yarpy", "connect", f"/127.0.0.1:{number}", "/view"]
    with (
        yarpy.BufferedPort("/view") as view,
        Process([*camera, f"http://127.0.0.1:{number}/{path}"]),
    ):
        environment = {**os.environ, **server.environment}

        def connected() -> bool:  # once ffmpeg listens
            with Process([*connect, f"mjpeg+path.{path}"], env=environment) as process:
                return process.wait(HANG) == 0

        wait_until(connected)
        image = view.read(timeout=HANG).value
        assert (image.width, image.height, image.code) == (64, 48, "rgb")


# ------------------------------------------------------------------------------ 7: web applications


@pytest.mark.peer("curl")
def test_web_page_looks_a_port_up_moves_it_and_asks_it(
    server: yarpy.NameServer, head: yarpy.RpcServer
) -> None:
    found = json.loads(curl(f"http://{server.address}/?req=query+$port&port={HEAD}"))
    assert found == {
        "type": "port",
        "name": HEAD,
        "ip": "127.0.0.1",
        "port_number": head.contact.port,
        "carrier": "tcp",
    }
    url = f"http://{found['ip']}:{found['port_number']}"
    curl(f"{url}/?req=set+pos+$axis+$angle&axis=1&angle=45")
    said = json.loads(curl(f"{url}/?req=get+encs"))
    assert said == ["is", "encs", [-0.000031, 45.0, 0.0, 0.0, 0.0, 0.0], "ok"]


@pytest.mark.peer("curl")
def test_browser_sees_what_a_camera_sees(server: yarpy.NameServer) -> None:
    picture = yarpy.Image(np.full((48, 64, 3), (200, 100, 50), "u1"))
    with yarpy.Port("/icubSim/cam") as port:
        found = json.loads(curl(f"http://{server.address}/?req=query+/icubSim/cam"))
        url = f"http://{found['ip']}:{found['port_number']}/?action=stream"
        args = [program("curl"), "-sN", "-m", "20", url]
        with subprocess.Popen(args, stdout=subprocess.PIPE) as process:
            assert port.wait_for_outputs(timeout=HANG)
            port.write(picture)
            assert process.stdout is not None
            data = jpeg.encode(picture)
            assert data in process.stdout.read(len(data) + 90)
            process.kill()


# ---------------------------------------------------------------------------------------- 8: people


@pytest.mark.peer("nc")
def test_garbage_gets_a_friendly_explanation(head: yarpy.RpcServer) -> None:
    said = run("nc", "127.0.0.1", str(head.contact.port), said="wepfokwoefp\n")
    lines = said.splitlines()
    assert lines[0] == "* Error. Protocol not found."
    assert lines[-1] == "* Goodbye."
    text = " ".join(line.removeprefix("*").strip() for line in lines)
    for words in (
        "Hello. You appear to be trying to communicate with a YARP Port.",
        "The first 8 bytes sent to a YARP Port are critical for identifying the protocol you wish "
        "to speak.",
        "The first 8 bytes you sent were not associated with any particular protocol.",
        'If you are a human, try typing "CONNECT foo" followed by a <RETURN>.',
        'The 8 bytes "CONNECT " correspond to a simple text-mode protocol.',
    ):
        assert words in text


@pytest.mark.peer("nc")
def test_help_says_what_one_may_type(head: yarpy.RpcServer) -> None:
    for word in ("help", "?", "h"):
        said = run("nc", "127.0.0.1", str(head.contact.port), said=f"CONNECT foo\n{word}\nq\n")
        assert said.startswith("Welcome foo\r\nThis is a YARP port.")
        for command in ("*", "d", "do", "q", "r", "/port", "!/port", "~/port", "a", "?"):
            assert f"\r\n{command} " in said
    said = run("nc", "127.0.0.1", str(head.contact.port), said="CONNECT foo\nxyz\nq\n")
    assert "Type ? for help." in said


@pytest.mark.peer("nc")
def test_head_is_moved_and_asked_with_netcat(head: yarpy.RpcServer) -> None:
    script = f"""{{
      # ask for a text-mode connection
      echo CONNECT test
      # send a request to move axis 1 to 45 degrees
      echo d
      echo set pos 1 45
      # wait for robot to move
      sleep 0.2
      # ask for encoder readings
      echo d
      echo get encs
      # pause to see results
      sleep 3
    }} | {program("nc")} -q 0 127.0.0.1 {head.contact.port}"""
    done = subprocess.run(["sh", "-c", script], capture_output=True, timeout=HANG, check=True)
    assert done.stdout.decode().splitlines() == [
        "Welcome test",
        "[ok]",
        "[is] [encs] (-3.100000000000000135e-05 45.0 -0.0 0.0 0.0 -0.0) [ok]",
    ]


@pytest.mark.peer("nc")
def test_direction_of_data_is_not_that_of_the_call(server: yarpy.NameServer) -> None:
    """Who opened the socket may read: no server is needed on its side, and no name."""
    with yarpy.Port("/out") as port:
        netcat = f"{program('nc')} 127.0.0.1 {port.contact.port}"
        script = f"{{ echo CONNECT me; echo r; sleep 10; }} | {netcat}"
        with Process(["sh", "-c", script]) as process:
            assert port.wait_for_outputs(timeout=HANG)
            port.write(["hi", 3])
            process.wait_line("^hi 3$", timeout=HANG)
            assert process.stdout.splitlines() == ["Welcome me", "D", "hi 3"]
