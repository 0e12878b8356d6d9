"""The C++ command `yarp` on yarpy ports: read, write, connect, exists, ping, admin, clean ..."""

import re
import sys
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy import Stamp

CARRIERS = ("tcp", "fast_tcp", "udp", "mcast", "text", "text_ack")


@pytest.fixture
def ports(network: CppYarp) -> Iterator[tuple[yarpy.Port, yarpy.BufferedPort]]:
    """Two ports of ours, `/from` and `/to`, not connected."""
    with yarpy.Port("/from") as source, yarpy.BufferedPort("/to", strict=True) as sink:
        yield source, sink


def test_write_to_us(network: CppYarp) -> None:
    """`yarp write`, connected by the tool itself and then over every carrier by `yarp connect`."""
    with (
        yarpy.BufferedPort("/ours", strict=True) as port,
        network.popen("write", "/writer", "/ours") as writer,
    ):
        writer.write_line('1 2.5 "a b" (c [d]) {1 2}')
        message = port.read(timeout=HANG)
        assert message.value == [1, 2.5, "a b", ["c", yarpy.Vocab("d")], b"\x01\x02"]
        assert (message.source, port.inputs[0].carrier) == ("/writer", "tcp")
        for carrier in CARRIERS:
            assert network.run("connect", "/writer", "/ours", carrier).returncode == 0
            wait_until(lambda: [link.carrier for link in port.inputs] == [carrier], what=carrier)  # noqa: B023
            writer.write_line(f"over {carrier}")
            assert port.read(timeout=HANG).value == ["over", carrier]
        writer.end_input()
        assert writer.wait() == 0
        wait_until(lambda: not port.inputs, what="the writer has left")


def test_read_from_us(network: CppYarp) -> None:
    """`yarp read` with envelopes, over every carrier; and its convention for plain text."""
    with yarpy.Port("/ours") as port, network.popen("read", "/reader", "envelope") as reader:
        reader.wait_line("Port /reader active")
        for count, carrier in enumerate(CARRIERS):
            answer = network.run("connect", "/ours", "/reader", carrier)
            assert answer.returncode == 0
            assert f"Added connection from /ours to {carrier}://reader" in answer.stdout
            reader.wait_line(f"Receiving input from /ours to /reader using {carrier}$")
            port.write([f"over {carrier}", 0.5], Stamp(count, 2.25))
            reader.wait_line(f"^{count} 2.25", stream="out")
            reader.wait_line(f'"over {carrier}" 0.5$', stream="out")
        port.write([0, "a line as it is"])
        reader.wait_line(r"(^|2\.2500\s+)a line as it is$", stream="out")  # YARP 4: behind it
        port.write([1, "<EOF>"])
        assert reader.wait() == 0
        wait_until(lambda: port.write(["anybody?"]) == 0 and not port.outputs)


def test_connect_and_disconnect(
    network: CppYarp, ports: tuple[yarpy.Port, yarpy.BufferedPort]
) -> None:
    source, sink = ports
    assert network.run("exists", "/from", "/to").returncode == 1
    for carrier in CARRIERS:
        answer = network.run("connect", "/from", "/to", carrier)
        assert (answer.returncode, answer.stdout, answer.stderr) == (
            0,
            f"[INFO] |yarp.os.Network| Success: Added connection from /from to {carrier}://to\n\n",
            "",
        )
        assert [link.carrier for link in source.outputs] == [carrier]
        assert sink.wait_for_inputs(timeout=HANG)
        source.write([carrier])
        assert sink.read(timeout=HANG).value == [carrier]
        # C++ compares the carrier, and asks for tcp.
        assert network.run("exists", "/from", "/to").returncode == (carrier != "tcp")
        answer = network.run("disconnect", "/from", "/to")
        assert answer.returncode == 0
        assert "Success: Removed connection from /from to /to" in answer.stdout
        assert source.outputs == []
        wait_until(lambda: not sink.inputs, what="the other end sees it too")
    failure = "[ERROR] |yarp.os.Network| Failure: "
    for words, text in (
        (["disconnect", "/from", "/to"], "no such connection"),
        (["connect", "/nope", "/to"], "could not find source port /nope"),
        (["connect", "/from", "/nope"], "could not find destination port /nope"),
        (["connect", "/from", "/to", "bogus"], "no way to make connection /from->bogus://to"),
    ):
        answer = network.run(*words)
        assert answer.returncode == 1
        assert failure + text in answer.stderr


def test_ping_and_exists(network: CppYarp, ports: tuple[yarpy.Port, yarpy.BufferedPort]) -> None:
    source, sink = ports
    source.connect("/to")
    answer = network.run("ping", "/from")
    assert (answer.returncode, answer.stdout) == (
        0,
        f'This is "/from" at "tcp://{source.address}/"\n'
        'There is an output connection from "/from" to "/to" using tcp\n'
        'There is an input connection from "<ping>" to "/from" using text_ack\n',
    )
    answer = network.run("ping", "/to")
    assert answer.returncode == 0
    assert "There are no outgoing connections\n" in answer.stdout
    assert 'There is an input connection from "/from" to "/to" using tcp\n' in answer.stdout
    assert network.run("ping", "/nope").returncode == 1
    assert network.run("exists", "/from").returncode == 0
    assert network.run("exists", "/from", "/to").returncode == 0
    assert network.run("exists", "/nope").returncode == 1
    # `wait` says true, which is 1.
    assert network.run("wait", "/to").returncode == 1
    address = f"/{sink.address}"
    assert network.run("exists", address).returncode == 0, "a port by its address alone"


def test_admin(network: CppYarp, ports: tuple[yarpy.Port, yarpy.BufferedPort]) -> None:
    source, _ = ports
    questions = (
        '[ver]\n[add] "/to" "udp"\n[list] [out]\n[list] [out] /to\n[list] [in] /to\n'
        "[prop] [set] colour (1 2)\n[prop] [get] colour\n[del] /to\n[del] /to\nbogus\n"
    )
    answer = network.run("admin", "rpc", "/from", input=questions)
    assert answer.returncode == 0
    assert answer.stdout.replace("\r", "\\r").splitlines() == [
        "Response: [ver] 1 2 3",
        'Response: 0 "Added connection from /from to udp://to\\r\\n"',
        'Response: "/to"',
        'Response: (from "/from") (to "/to") (carrier udp) (connectionless 1)',
        "Response: ",
        "Response: [ok]",
        "Response: (1 2)",
        'Response: 0 "Removed connection from /from to /to\\r\\n"',
        'Response: -1 "Could not find an outgoing connection to /to\\r\\n'
        'Could not find an incoming connection from /to\\r\\n"',
        'Response: [fail] "send [help] for list of valid commands"',
    ]
    assert source.outputs == []
    with network.popen("read", "/theirs") as reader:
        reader.wait_line("Port /theirs active")
        help_ = [
            network.run("admin", "rpc", p, input="[help]\n").stdout for p in ("/from", "/theirs")
        ]
        assert help_[0] == help_[1]


def test_quality_of_service(network: CppYarp, ports: tuple[yarpy.Port, yarpy.BufferedPort]) -> None:
    source, sink = ports
    source.connect("/to")
    assert sink.wait_for_inputs(timeout=HANG)
    set_ = network.run("priority-qos", "set", "/from", "/to", "--src", "LEVEL:HIGH")
    assert set_.returncode == 0
    answer = network.run("priority-qos", "get", "/from", "/to").stdout
    assert answer == "(src (qos ((tos 144)))) (des (qos ((tos 0))))\n"
    answer = network.run("priority-sched", "get", "/from", "/to").stdout
    assert "(des (sched ((policy 0) (priority 0))))" in answer


OTHER = """
import time, yarpy
with yarpy.Port("/other"):
    print("ready", flush=True)
    time.sleep(600)
"""


def test_clean_removes_the_dead_only(network: CppYarp) -> None:
    with yarpy.Port("/alive"), Process([sys.executable, "-c", OTHER]) as other:
        other.wait_line("ready")
        other.kill()
        assert yarpy.query("/other") is not None
        cleaned = network.run("clean", "--timeout", "10")
        assert cleaned.returncode == 0
        assert re.search(
            "Testing /other at .*\n.* No response, removing port /other", cleaned.stdout
        )
        assert yarpy.query("/other") is None
        assert yarpy.query("/alive") is not None


def test_ports_without_any_name_server(cpp: CppYarp) -> None:
    """Addresses instead of names, both ways; nothing is registered anywhere."""
    with (
        yarpy.Port("") as port,
        CppYarp(cpp.root, cpp.home).popen("write", "/nameless", f"/{port.address}") as writer,
    ):
        writer.write_line("hello")
        assert port.read(timeout=HANG).value == ["hello"]
