"""Ends of connections between C++ and yarpy: in every order, in good order and by killing."""

import sys
import time
from collections.abc import Callable

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.lasted import lasted
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.connect.reconnect import RECONNECTOR

CARRIERS = ("tcp", "fast_tcp", "udp", "mcast", "text", "text_ack")
TWO_PORTS = """
a, b = yarp.Port(), yarp.BufferedPortBottle()
assert a.open('/cpp/a') and b.open('/cpp/b')
"""


@pytest.fixture(scope="module")
def network(our_names: CppYarp) -> CppYarp:
    """One name server is enough: what is shown here does not depend on it."""
    return our_names


def flows(port: yarpy.BufferedPort, send: Callable[[], object] = lambda: None) -> None:
    """Something that was sent just now arrives at `port`."""
    while port.poll() is not None:  # from before
        pass
    deadline = time.monotonic() + HANG
    while time.monotonic() < deadline:
        send()
        try:
            port.read(timeout=0.05)
            return
        except yarpy.Timeout:
            continue
    raise AssertionError(f"nothing arrives at {port.name}")


@pytest.mark.parametrize("carrier", CARRIERS)
def test_they_close_first(peer: CppProgram, carrier: str) -> None:
    """Sender and receiver of theirs; ours see it, and live on."""
    peer.do(TWO_PORTS)
    with yarpy.Port("/out") as source, yarpy.BufferedPort("/in", strict=True) as sink:
        source.connect("/cpp/b", carrier)
        sink.listen_to("/cpp/a", carrier)
        assert sink.wait_for_inputs(timeout=HANG)
        flows(sink, lambda: peer.do("a.write(yarp.Bottle('x'))"))
        began = time.monotonic()
        peer.do("a.close(); b.close()")
        assert lasted(began) < 3
        wait_until(lambda: not sink.inputs, what="the sender is gone")
        wait_until(lambda: not source.outputs, what="the receiver is gone")
        assert source.write(["nobody"]) == 0
        # The names are free for somebody else, who begins unconnected.
        peer.do("a, b = yarp.Port(), yarp.Port(); assert a.open('/cpp/a') and b.open('/cpp/b')")
        time.sleep(0.7)
        assert not (sink.inputs or source.outputs)


@pytest.mark.parametrize("carrier", CARRIERS)
def test_we_close_first(peer: CppProgram, carrier: str) -> None:
    peer.do(TWO_PORTS)
    counts = "[a.getOutputCount(), b.getInputCount()]"
    with yarpy.Port("/out") as source, yarpy.BufferedPort("/in", strict=True) as sink:
        source.connect("/cpp/b", carrier)
        sink.listen_to("/cpp/a", carrier)
        assert sink.wait_for_inputs(timeout=HANG)
        flows(sink, lambda: peer.do("a.write(yarp.Bottle('x'))"))
        # A question whether it lives counts as an input as long as that takes.
        wait_until(lambda: peer.do(counts) == [1, 1])
        began = time.monotonic()
        source.close()
        sink.close()
        assert lasted(began) < 3
    wait_until(lambda: peer.do(counts) == [0, 0])
    assert peer.do("a.write(yarp.Bottle('x'))"), "the sender lives on"
    assert yarpy.query("/out") is None and yarpy.query("/in") is None


def test_their_receiver_drops_us(peer: CppProgram) -> None:
    """A C++ port that was told to drop an input of ours: it says nothing, we must not hang."""
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    with yarpy.Port("/ours") as source:
        for carrier in ("tcp", "fast_tcp", "text_ack"):
            source.connect("/cpp", carrier)
            assert peer.do("yarp.Network.disconnectInput('/cpp', '/ours', True)") == 0
            for number in range(5):
                source.write([number])
                time.sleep(0.01)
            source.disconnect("/cpp")
            source.connect("/cpp", carrier)
            source.write(["again"])
            assert source.flush(timeout=HANG)
            wait_until(lambda: peer.do("b = port.read(False); b and b.toString()") == "again")
            source.disconnect("/cpp")


def test_in_the_middle_of_everything(peer: CppProgram) -> None:
    """Closing while the other side is sending without a pause."""
    for turn in range(5):
        peer.do(
            "import threading\n"
            f"port = yarp.Port(); assert port.open('/cpp{turn}'); running = True\n"
            "def send():\n"
            "    bottle = yarp.Bottle('1 2 3')\n"
            "    while running: port.write(bottle)\n"
            "thread = threading.Thread(target=send); thread.start()"
        )
        with yarpy.BufferedPort("/ours", strict=turn % 2 == 0) as sink:
            sink.listen_to(f"/cpp{turn}")
            flows(sink)
            if turn < 2:
                peer.do("running = False; thread.join(); port.close()")
            began = time.monotonic()
        assert lasted(began) < 3, f"turn {turn}: closing takes long"
        peer.do("running = False; thread.join(); port.close()")


# --- killing

CPP_WRITER = """
import sys, time, yarp
yarp.Network.init()
port = yarp.Port()
assert port.open('/killed/out')
if len(sys.argv) > 1: assert yarp.Network.connect('/killed/out', '/ours', sys.argv[1])
n = 0
while True:
    port.write(yarp.Bottle(f'{n}')); n += 1
    time.sleep(0.01)
"""
CPP_READER = """
import yarp
yarp.Network.init()
port = yarp.BufferedPortBottle()
assert port.open('/killed/in')
while True:
    print('got', port.read().toString(), flush=True)
"""
CPP_SERVER = """
import yarp
yarp.Network.init()
port = yarp.RpcServer()
assert port.open('/killed/rpc')
while True:
    question = yarp.Bottle()
    if port.read(question, True): port.reply(question)
"""


def is_looked_up(port: yarpy.BufferedPort) -> bool:
    found = map(RECONNECTOR._keepalive._signs.get, port._hub.inputs.links)
    return any(sign is not None and sign.contact is not None for sign in found)


@pytest.mark.parametrize("carrier", CARRIERS)
def test_a_killed_sender_of_theirs(network: CppYarp, carrier: str) -> None:
    """It starts again unconnected; we ask it to send to us as before."""
    with yarpy.BufferedPort("/ours") as port:
        writer = network.python_popen(CPP_WRITER, carrier)
        for _ in range(2):
            flows(port)
            if carrier in ("udp", "mcast"):
                # A sender of datagrams has to be looked up while it lives.
                wait_until(lambda: is_looked_up(port), what="looked up")
            writer.kill()
            wait_until(lambda: not port.inputs, what="its end is seen")
            writer = network.python_popen(CPP_WRITER)
        flows(port)
        assert port.inputs[0].carrier == carrier
        writer.stop(grace=0)


@pytest.mark.parametrize("carrier", CARRIERS)
def test_a_killed_reader_of_theirs(network: CppYarp, carrier: str) -> None:
    """We connect to the new one; what is written meanwhile is not an error."""
    with yarpy.Port("/ours") as port:
        for turn in range(2):
            with network.python_popen(CPP_READER) as reader:
                reader.wait_line("Port /killed/in active")
                if turn == 0:
                    port.connect("/killed/in", carrier)
                deadline = time.monotonic() + HANG
                while f"got {turn}\n" not in reader.stdout:
                    assert time.monotonic() < deadline, (
                        f"turn {turn}: {port.outputs}, {port.stats}, {reader.stdout!r}"
                    )
                    port.write([turn])
                    time.sleep(0.01)
                reader.kill()
            for _ in range(10):
                port.write(["nobody"])
                time.sleep(0.01)


def test_a_killed_server_of_theirs(network: CppYarp) -> None:
    with network.python_popen(CPP_SERVER) as server:
        server.wait_line("Port /killed/rpc active")
        client = yarpy.RpcClient("/killed/rpc", name="/ours")
        assert client.call("one", timeout=HANG) == ["one"]
        server.kill()
        with pytest.raises(yarpy.LinkClosed):
            client.call("nobody", timeout=HANG)
    with client, network.python_popen(CPP_SERVER) as server:
        server.wait_line("Port /killed/rpc active")
        assert client.call("two", timeout=HANG) == ["two"], "the next call finds the new one"


OURS = """
import sys, time, yarpy
with yarpy.Port("/ours") as port:
    print("ready", flush=True)
    for n in range(10**9):
        port.write([n])
        time.sleep(0.01)
"""


def test_we_are_killed(peer: CppProgram) -> None:
    """A C++ receiver gets over it, and the next program of our name is heard like the first."""
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    for _ in range(2):
        with Process([sys.executable, "-c", OURS]) as ours:
            ours.wait_line("ready")
            assert peer.do("yarp.Network.connect('/ours', '/cpp')")
            assert peer.do("port.read().size()") == 1
            ours.kill()
        wait_until(lambda: peer.do("port.getInputCount()") == 0, what="it sees our end")
