"""The three settings of docs/security.md, tried from another host: a network namespace.

The robot has a foot in two networks, the stranger in both as well. Needs root and iproute2.
"""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.namespace import ip
from support.peer import brings
from support.process import Process

PREFIX = f"z{os.getpid() % 10000}"
ROBOT, ASIDE = "10.78.1.1", "10.78.2.1"
PORT = 10000


@pytest.fixture(scope="module")
@brings("namespaces")
def hosts() -> Iterator[tuple[str, str]]:
    """The namespaces of the robot and of the stranger."""
    robot, stranger = f"{PREFIX}robot", f"{PREFIX}far"
    try:
        for name in (robot, stranger):
            ip("netns", "add", name)
            ip("-n", name, "link", "set", "lo", "up")
        for number in (1, 2):
            near, far = f"{PREFIX}n{number}", f"{PREFIX}f{number}"
            ip("link", "add", near, "netns", robot, "type", "veth",
               "peer", "name", far, "netns", stranger)  # fmt: skip
            for host, device, last in ((robot, near, 1), (stranger, far, 2)):
                ip("-n", host, "addr", "add", f"10.78.{number}.{last}/24", "dev", device)
                ip("-n", host, "link", "set", device, "up")
        yield robot, stranger
    finally:
        for name in (robot, stranger):
            ip("netns", "del", name, check=False)


RUNS = f"""
import sys, time, yarpy
host = sys.argv[1]
with yarpy.NameServer({PORT}, host) as server:
    with yarpy.RpcServer("/arm", lambda m: ["moved", *m.value]):
        with yarpy.RpcClient() as own:
            own.connect("/arm")
            print("ready", own.call("up").to_text(), flush=True)
            time.sleep(120)
"""
TRIES = """
import http.client, socket, sys, urllib.error, urllib.request
import yarpy
from yarpy.contact import Contact
from yarpy.port.connect.probe import Caller

host = sys.argv[1]

def tried(what, step):
    try:
        print(what, step(), flush=True)
    except (OSError, yarpy.YarpError, http.client.HTTPException) as error:
        print(what, "refused", error, flush=True)

def call(*words, admin=False):
    with Caller(Contact("tcp", "/arm", host, 10002), admin=admin, timeout=5) as caller:
        return caller.ask(yarpy.Bottle(words), 5).value.to_text()

def page(origin):
    request = urllib.request.Request(f"http://{host}:10002/?req=up", headers={"Origin": origin})
    return urllib.request.urlopen(request, timeout=5).status

def text():
    with socket.create_connection((host, 10002), 5) as sock:
        sock.sendall(b"CONNECT me\\r\\n")
        return sock.recv(100)

def names():
    with yarpy.YarpNameClient(host, 10000, timeout=5) as client:
        return client.query("/arm") is not None

tried("call:", lambda: call("up"))
tried("script:", lambda: call("atch", "in", "(type python) (file evil)", admin=True))
tried("page:", lambda: page("http://evil.example"))
tried("text:", text)
tried("names:", names)
"""


def run(host: str, code: str, address: str, **environment: str) -> Process:
    line = ["ip", "netns", "exec", host, sys.executable, "-c", code, address]
    known = {k: v for k, v in os.environ.items() if not k.startswith("YARPY_")}
    return Process(line, env={**known, **environment})


def tries(host: str, address: str, **environment: str) -> dict[str, str]:
    """What somebody gets who tries everything at an address."""
    with run(host, TRIES, address, **environment) as process:
        assert process.wait(60) == 0, process.stderr
        lines = [line.partition(": ") for line in process.stdout.splitlines()]
        return {what: said for what, colon, said in lines if colon}


def test_my_laptop(hosts: tuple[str, str]) -> None:
    robot, stranger = hosts
    with run(robot, RUNS, "127.0.0.1", YARPY_BIND="local") as process:
        process.wait_line("ready moved up", timeout=30)
        for address in (ROBOT, ASIDE):
            assert all("refused" in said for said in tries(stranger, address).values())


def test_a_laboratory(hosts: tuple[str, str]) -> None:
    robot, stranger = hosts
    with run(robot, RUNS, ROBOT, YARPY_BIND=ROBOT) as process:
        process.wait_line("ready moved up", timeout=30)
        found = tries(stranger, ROBOT)
        assert found["call"] == "moved up"
        assert "YARPY_SCRIPTS" in found["script"]
        assert "403" in found["page"]
        assert "Welcome" in found["text"]
        assert found["names"] == "True"
        assert all("refused" in said for said in tries(stranger, ASIDE).values())


def test_the_internet(hosts: tuple[str, str], tmp_path: Path) -> None:
    pytest.importorskip("cryptography", reason='certificates: pip install "yarpy[tls]"')
    from yarpy.config.authority import make

    robot, stranger = hosts
    make(tmp_path / "robot", [ROBOT])
    make(tmp_path / "friend", ["10.78.1.2"], tmp_path / "robot")
    own = {"YARPY_TLS": "mutual", "YARPY_TLS_DIR": str(tmp_path / "robot")}
    with run(robot, RUNS, ROBOT, **own) as process:
        process.wait_line("ready moved up", timeout=30)
        friend = {"YARPY_TLS": "mutual", "YARPY_TLS_DIR": str(tmp_path / "friend")}
        found = tries(stranger, ROBOT, **friend)
        assert (found["call"], found["names"]) == ("moved up", "True")
        for nobody in ({}, {"YARPY_TLS": "require", "YARPY_TLS_DIR": str(tmp_path / "none")}):
            found = tries(stranger, ROBOT, **nobody)
            assert "TLS alone" in found.pop("text")
            assert all("refused" in said for said in found.values()), found
        # One who trusts the authority, and has no certificate of it.
        (tmp_path / "half").mkdir()
        (tmp_path / "half" / "ca.pem").write_bytes((tmp_path / "robot" / "ca.pem").read_bytes())
        found = tries(stranger, ROBOT, **{**friend, "YARPY_TLS_DIR": str(tmp_path / "half")})
        assert "refused" in found["call"]
        assert "refused" in found["names"]
