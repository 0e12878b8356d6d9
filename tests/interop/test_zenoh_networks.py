"""Three hosts with a router of Zenoh each; one is behind a translation of addresses (NAT), so that
nobody can dial it.

The hosts are network namespaces: `lab` and `robot` have a link to `middle`, which lets the robot
out to the lab under its own address where nftables are installed, and else forwards nothing at all.
Needs root and iproute2.
"""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.namespace import ip
from support.peer import brings, program
from support.process import Process
from support.wait import HANG, wait_until

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')

SHOWN = re.compile(r'"frames": ?[1-9]')
PREFIX = f"z{os.getpid() % 10000}"
LAB, ROBOT = "10.79.1", "192.168.179"
NAT = f"""
table ip nat {{
    chain out {{
        type nat hook postrouting priority 100;
        ip saddr {ROBOT}.0/24 masquerade
    }}
}}
"""


def translate(host: str) -> bool:
    """Let the robot out by a translation of addresses; return False if the system has none."""
    inside = ["ip", "netns", "exec", host]
    done = subprocess.run(
        [*inside, program("nft"), "-f", "-"], input=NAT, text=True, capture_output=True
    )
    if done.returncode == 0:
        subprocess.run([*inside, "sysctl", "-qw", "net.ipv4.ip_forward=1"], check=True)
    return done.returncode == 0


@pytest.fixture(scope="module")
@brings("namespaces", "nft")
def hosts() -> Iterator[dict[str, str]]:
    """Names of the namespaces by role."""
    names = {role: f"{PREFIX}{role}" for role in ("middle", "lab", "robot")}
    try:
        for name in names.values():
            ip("netns", "add", name)
            ip("-n", name, "link", "set", "lo", "up")
        for role, network in (("lab", LAB), ("robot", ROBOT)):
            near, far = f"{PREFIX}{role[0]}m", f"{PREFIX}{role[0]}h"
            ip("link", "add", near, "netns", names["middle"], "type", "veth",
               "peer", "name", far, "netns", names[role])  # fmt: skip
            for host, device, number in ((names["middle"], near, 1), (names[role], far, 2)):
                ip("-n", host, "addr", "add", f"{network}.{number}/24", "dev", device)
                ip("-n", host, "link", "set", device, "up")
        ip("-n", names["robot"], "route", "add", "default", "via", f"{ROBOT}.1")
        translate(names["middle"])
        yield names
    finally:
        for name in names.values():
            ip("netns", "del", name, check=False)


class Programs:
    """Programs in the namespaces, as a person starts them."""

    def __init__(self, hosts: dict[str, str], home: Path) -> None:
        self._hosts = hosts
        self._environment = {
            **{k: v for k, v in os.environ.items() if not k.startswith(("YARP", "ZENOH"))},
            "YARP_CONFIG_HOME": str(home),
            "YARPY_SERVER": "zenoh",
        }

    def _inside(self, host: str, *words: str) -> list[str]:
        return ["ip", "netns", "exec", self._hosts[host], sys.executable, *words]

    def start(self, host: str, *words: str) -> Process:
        """`yarpy WORDS` there."""
        return Process(self._inside(host, "-m", "yarpy", *words), env=self._environment)

    def run(self, host: str, *words: str, input: str = "") -> str:
        """What `yarpy WORDS` prints there."""
        done = subprocess.run(
            self._inside(host, "-m", "yarpy", *words), env=self._environment, text=True,
            input=input, capture_output=True, timeout=HANG,
        )  # fmt: skip
        return done.stdout

    def fetch(self, host: str, url: str) -> str:
        """What a browser gets there."""
        code = f"import urllib.request as u; print(u.urlopen({url!r}, timeout=10).read().decode())"
        return subprocess.run(
            self._inside(host, "-c", code), text=True, capture_output=True, timeout=HANG
        ).stdout

    def python(self, host: str, code: str) -> Process:
        """A program there that says `ready`."""
        process = Process(self._inside(host, "-u", "-c", code), env=self._environment)
        process.wait_line("ready", timeout=HANG)
        return process


@pytest.fixture
def programs(hosts: dict[str, str], tmp_path: Path) -> Programs:
    return Programs(hosts, tmp_path)


@pytest.fixture
def routers(programs: Programs) -> Iterator[None]:
    """Those of the lab and the robot; both call the middle one, which may come and go."""
    middle = f"tcp/{LAB}.1:7447", f"tcp/{ROBOT}.1:7447"
    with (
        programs.start("lab", "router", "--connect", middle[0]) as lab,
        programs.start("robot", "router", "--connect", middle[1]) as robot,
    ):
        lab.wait_line("Zenoh router")
        robot.wait_line("Zenoh router")
        yield


def middle(programs: Programs) -> Process:
    process = programs.start("middle", "router", "tcp/0.0.0.0:7447")
    process.wait_line("Zenoh router")
    return process


ROBOT_PROGRAM = """
import numpy, yarpy
image = yarpy.Image(numpy.full((8, 8, 3), 200, numpy.uint8))
with (
    yarpy.BufferedPort("/robot/in", strict=True) as in_,
    yarpy.RpcServer("/robot/rpc", lambda message: ["at", "home", *message.value]),
    yarpy.BufferedPort("/robot/cam") as camera,
):
    print("ready")
    while True:
        camera.write(image)
        try:
            print("got", in_.read(timeout=0.1).value[0])
        except yarpy.Timeout:
            pass
"""
LAB_PROGRAM = """
import signal, time, yarpy
ended = []  # an Event has a lock, which the main thread may hold where the signal comes
signal.signal(signal.SIGINT, lambda *_: ended.append(True))
with yarpy.Port("/lab/out") as out:
    out.connect("/robot/in", timeout=30)
    print("ready")
    taken = number = 0
    while not ended:
        time.sleep(0.01)
        number += 1
        taken += out.write([number])
        print("sent", number)
    out.flush(10)
    past = out.stats.past.outputs
    dropped = past.drops + sum(one.drops for one in out.stats.outputs)
    print("counted", number, taken, out.stats.unconnected, dropped, past.unconfirmed)
"""


@pytest.mark.usefixtures("routers")
def test_a_robot_that_nobody_can_dial_is_reached_and_comes_back(programs: Programs) -> None:
    with middle(programs) as hub, programs.python("robot", ROBOT_PROGRAM) as robot:
        wait_until(lambda: "/robot/rpc" in programs.run("lab", "name", "list"))
        assert ".zenoh" in programs.run("lab", "name", "query", "/robot/rpc")
        assert "Response: at home now" in programs.run("lab", "rpc", "/robot/rpc", input="now\n")
        with programs.start("lab", "read", "/lab/in", "/robot/cam") as reader:
            reader.wait_line(r"\[mat\]|rgb|{", timeout=HANG)
        with programs.start("lab", "view", "--no-browser", "--connect", "/robot/cam") as view:
            url = view.wait_line(r"http://\S+/", timeout=HANG)[0]
            wait_until(lambda: SHOWN.search(programs.fetch("lab", f"{url}status")))
        with programs.python("lab", LAB_PROGRAM) as lab:
            robot.wait_line("got 20$", timeout=HANG)
            hub.signal(signal.SIGKILL)
            hub.wait()
            before = len(robot.stdout.splitlines())
            wait_until(lambda: "/robot/in" not in programs.run("lab", "name", "list"))
            with middle(programs):
                wait_until(lambda: len(robot.stdout.splitlines()) > before + 50)
                assert ".zenoh" in programs.run("lab", "name", "query", "/robot/rpc")
                lab.signal(signal.SIGINT)
                lab.wait()
                counted = lab.wait_line(r"counted (\d+) (\d+) (\d+) (\d+) (\d+)").groups()
                written, taken, unconnected, dropped, unconfirmed = map(int, counted)
                wait_until(lambda: len(received(robot)) >= taken - unconfirmed)
        assert written == taken + unconnected + dropped  # nothing is lost without being counted
        got = received(robot)
        assert got == sorted(set(got)) and taken - unconfirmed <= len(got) <= written
        assert unconnected


def received(robot: Process) -> list[int]:
    """The numbers that the robot got, as they came."""
    return [int(line[4:]) for line in robot.stdout.splitlines() if line.startswith("got")]
