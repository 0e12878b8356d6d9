"""Hosts with several networks: the addresses that ports register can be reached by who needs them.

Three hosts are network namespaces: `server` has a foot in both networks, `left` and `right` in one
each. Needs root and iproute2.
"""

import os
import sys
from collections.abc import Iterator

import pytest
from support.namespace import ip
from support.peer import brings
from support.process import Process
from support.wait import HANG

PREFIX = f"y{os.getpid() % 10000}"
LEFT, RIGHT = "10.77.1", "10.77.2"
PORT = 10000


@pytest.fixture(scope="module")
@brings("namespaces")
def hosts() -> Iterator[dict[str, str]]:
    """Names of the namespaces by role."""
    names = {role: f"{PREFIX}{role}" for role in ("server", "left", "right")}
    try:
        for name in names.values():
            ip("netns", "add", name)
            ip("-n", name, "link", "set", "lo", "up")
        for role, network in (("left", LEFT), ("right", RIGHT)):
            near, far = f"{PREFIX}{role[0]}s", f"{PREFIX}{role[0]}h"
            ip("link", "add", near, "netns", names["server"], "type", "veth",
               "peer", "name", far, "netns", names[role])  # fmt: skip
            for host, device, number in ((names["server"], near, 1), (names[role], far, 2)):
                ip("-n", host, "addr", "add", f"{network}.{number}/24", "dev", device)
                ip("-n", host, "link", "set", device, "up")
        yield names
    finally:
        for name in names.values():
            ip("netns", "del", name, check=False)


def start(host: str, code: str, server: str, **environment: str) -> Process:
    """Run Python code in a namespace and wait until it says `ready`."""
    process = Process(
        ["ip", "netns", "exec", host, sys.executable, "-c", code],
        env={**os.environ, "YARPY_SERVER": f"{server}:{PORT}", **environment},
    )
    process.wait_line("ready", timeout=HANG)
    return process


SERVER = f"""
import time, yarpy
with yarpy.NameServer({PORT}, "{LEFT}.1"):
    print("ready", flush=True)
    time.sleep(120)
"""
READER = """
import yarpy
with yarpy.Port("/networks/{name}") as port:
    print("ready", port.contact.host, flush=True)
    for message in port:
        print("got", message.value, flush=True)
"""
WRITER = """
import yarpy
with yarpy.Port("/networks/out") as port:
    port.connect("/networks/{name}", "{carrier}")
    print("ready", port.contact.host, flush=True)
    import time
    while True:  # a receiver joins its group a moment after it was connected
        port.write(["hello", "{carrier}"])
        time.sleep(0.05)
"""


@pytest.fixture
def server(hosts: dict[str, str]) -> Iterator[Process]:
    with start(hosts["server"], SERVER, f"{LEFT}.1") as process:
        yield process


@pytest.mark.usefixtures("server")
def test_a_port_registers_the_address_that_leads_to_the_server(hosts: dict[str, str]) -> None:
    for role, network in (("left", LEFT), ("right", RIGHT)):
        with start(hosts[role], READER.format(name=role), f"{network}.1") as reader:
            assert f"ready {network}.2" in reader.stdout


@pytest.mark.usefixtures("server")
def test_a_port_beside_the_server_is_not_registered_as_loopback(hosts: dict[str, str]) -> None:
    with start(hosts["server"], READER.format(name="near"), "127.0.0.1") as reader:
        assert f"ready {LEFT}.1" in reader.stdout
        with start(hosts["left"], WRITER.format(name="near", carrier="tcp"), f"{LEFT}.1"):
            reader.wait_line(r"got .*hello.*tcp")


@pytest.mark.usefixtures("server")
@pytest.mark.parametrize("carrier", ["tcp", "udp", "mcast"])
def test_a_port_of_two_networks_is_reached_from_the_other_one(
    hosts: dict[str, str], carrier: str
) -> None:
    """It is registered with its left address; the right host, with no way there, finds another."""
    with start(hosts["server"], READER.format(name="both"), f"{LEFT}.1") as reader:
        assert f"ready {LEFT}.1" in reader.stdout
        code = WRITER.format(name="both", carrier=carrier)
        with start(hosts["right"], code, f"{RIGHT}.1"):
            reader.wait_line(rf"got .*hello.*{carrier}")


@pytest.mark.usefixtures("server")
def test_the_variable_yarp_ip_chooses_the_address(hosts: dict[str, str]) -> None:
    code = READER.format(name="chosen")
    with start(hosts["server"], code, f"{LEFT}.1", YARP_IP=f"{RIGHT}.") as reader:
        assert f"ready {RIGHT}.1" in reader.stdout
