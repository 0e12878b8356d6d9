"""Questions and answers between C++ and yarpy, both ways, and over the administrative channel."""

import threading
import time

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, Message, Vocab

# The carriers over which an answer can come back to who asked.
CARRIERS = ("tcp", "text_ack")
# ... and those over which a C++ port believes it: the text carrier has replies, but no way to end.
CPP_SERVER = """
server = yarp.RpcServer()
assert server.open('/server')
def serve(count, make=None):
    for _ in range(count):
        question, answer = yarp.Bottle(), yarp.Bottle()
        server.read(question, True)
        answer.fromString((make or (lambda q: 'ok ' + q))(question.toString()))
        server.reply(answer)
"""
CPP_CLIENT = """
client = yarp.RpcClient()
assert client.open('/client')
def ask(text):
    question, answer = yarp.Bottle(text), yarp.Bottle()
    return client.write(question, answer) and answer.toString()
"""


def echo(message: Message) -> object:
    return ["ok", *message.value]


@pytest.mark.parametrize("carrier", CARRIERS)
def test_cpp_asks(peer: CppProgram, carrier: str) -> None:
    peer.do(CPP_CLIENT)
    with yarpy.RpcServer("/server", echo) as server:
        assert peer.do(f"yarp.Network.connect('/client', '/server', '{carrier}')")
        assert peer.do("[ask('add 1 2.5'), ask('(a b) \"x y\" [set]'), ask('')]") == [
            "ok add 1 2.5",
            'ok (a b) "x y" [set]',
            "ok",
        ]
        assert server.inputs[0].carrier == carrier
        assert peer.do("[ask(str(i)) for i in range(500)] == [f'ok {i}' for i in range(500)]")


@pytest.mark.parametrize("carrier", CARRIERS)
def test_cpp_asks_an_interrupted_server(peer: CppProgram, carrier: str) -> None:
    """It is told that there is no answer, and its connection comes back."""
    peer.do(CPP_CLIENT)
    with yarpy.RpcServer("/server", echo) as server:
        assert peer.do(f"yarp.Network.connect('/client', '/server', '{carrier}')")
        assert peer.do("ask('1')") == "ok 1"
        server.interrupt()
        assert peer.do("ask('2')") is False
        server.resume()
        assert server.wait_for_inputs(timeout=HANG)
        wait_until(lambda: peer.do("ask('3')") == "ok 3")


@pytest.mark.parametrize("carrier", CARRIERS)
def test_yarpy_asks(peer: CppProgram, carrier: str) -> None:
    peer.do(CPP_SERVER)
    with yarpy.RpcClient("/server", name="/client", carrier=carrier) as client:
        peer.begin("serve(3)")
        assert client.call("add", 1, 2.5) == ["ok", "add", 1, 2.5]
        assert client.call(["a", "b"], "x y", Vocab("set")) == ["ok", ["a", "b"], "x y", "set"]
        assert client.call(Bottle()) == ["ok"]
        peer.end()
        peer.begin("serve(500)")
        for number in range(500):
            assert client.call(number) == ["ok", number]
        peer.end()


def test_answers_that_are_no_lists(peer: CppProgram) -> None:
    """What a handler may return, as a C++ client sees it, whose questions do not tell how floats
    are spelled for it."""
    peer.do(CPP_CLIENT)
    answers: dict[str, tuple[object, str]] = {
        "text": ("hello there", '"hello there"'),
        "number": (5, "5"),
        "float": (2.5, "2.5"),
        "nothing": (None, ""),
        "map": ({"b": 2, "a": [1, "x"]}, "(a (1 x)) (b 2)"),
        "vector": (yarpy.Vector([1.5, 2.5]), "1.5 2.5"),
        "many": ([Vocab("many"), "one", "two"], "[many] one two"),
        "yes": (True, "true"),
    }
    with yarpy.RpcServer("/server", lambda message: answers[message.value[0]][0]):
        assert peer.do("yarp.Network.connect('/client', '/server')")
        seen = peer.do(f"[ask(key) for key in {list(answers)!r}]")
        assert seen == [shown for _, shown in answers.values()]
        assert peer.do("ask('unknown')") == ("[fail] \"KeyError: 'unknown'\" (raised KeyError)")
        assert peer.do("ask('text')") == '"hello there"', "the connection lives on"


def test_a_plain_port_answers_and_asks(peer: CppProgram) -> None:
    """Port.read and Message.reply instead of a server; C++ Port.reply instead of RpcServer."""
    peer.do(CPP_CLIENT)
    with yarpy.Port("/server") as port:
        assert peer.do("yarp.Network.connect('/client', '/server')")
        peer.begin("ask('one')")
        message = port.read(timeout=HANG)
        assert message.wants_reply
        message.reply(["answer", *message.value])
        assert peer.end() == "answer one"
        # A question that nobody answers: C++ gets an empty reply instead of waiting for ever.
        peer.begin("ask('two')")
        assert port.read(timeout=HANG).value == ["two"]
        with pytest.raises(yarpy.Timeout):
            port.read(timeout=0.05)
        assert peer.end() == ""
    peer.do("port = yarp.Port(); assert port.open('/plain')")
    with yarpy.RpcClient("/plain") as client:
        peer.begin(
            "question = yarp.Bottle(); port.read(question, True)\nport.reply(yarp.Bottle('yes'))"
        )
        assert client.call("really?") == ["yes"]
        assert peer.end()


def test_a_buffered_port_takes_calls(peer: CppProgram) -> None:
    """A C++ client that asks a port which never answers goes on with an empty answer."""
    peer.do(CPP_CLIENT)
    with yarpy.BufferedPort("/server", strict=True) as port:
        assert peer.do("yarp.Network.connect('/client', '/server')")
        assert peer.do("[ask('one'), ask('two')]") == ["", ""]
        assert [port.read(timeout=HANG).value for _ in range(2)] == [["one"], ["two"]]


def test_a_client_of_two_servers_in_turn(peer: CppProgram) -> None:
    peer.do(CPP_SERVER)
    with (
        yarpy.RpcServer("/ours", echo),
        yarpy.RpcClient(name="/client") as client,
    ):
        client.connect("/ours")
        assert client.call("x") == ["ok", "x"]
        # An RPC output takes one connection at a time, as in C++.
        with pytest.raises(yarpy.LocalProtocolError, match="RPC output already connected"):
            client.connect("/server")
        client.disconnect("/ours")
        client.connect("/server")
        peer.begin("serve(1)")
        assert client.call("x") == ["ok", "x"]
        peer.end()


def test_a_server_with_many_clients(peer: CppProgram) -> None:
    """C++ and yarpy clients at once; nobody gets somebody else's answer."""
    peer.do(CPP_CLIENT)
    wrong: list[object] = []

    def ask(number: int) -> None:
        with yarpy.RpcClient("/server") as client:
            for turn in range(100):
                answer = client.call(number, turn, timeout=HANG)
                if answer != ["ok", number, turn]:
                    wrong.append(answer)

    with yarpy.RpcServer("/server", echo):
        assert peer.do("yarp.Network.connect('/client', '/server')")
        threads = [threading.Thread(target=ask, args=(number,)) for number in range(3)]
        for thread in threads:
            thread.start()
        assert peer.do("all(ask(f'cpp {i}') == f'ok cpp {i}' for i in range(300))")
        for thread in threads:
            thread.join(HANG)
            assert not thread.is_alive()
    assert wrong == []


def test_a_call_that_takes_too_long(peer: CppProgram) -> None:
    peer.do(CPP_SERVER)
    with yarpy.RpcClient("/server", name="/client") as client:
        peer.begin("serve(1, lambda question: time.sleep(2) or 'too late')")
        began = time.monotonic()
        with pytest.raises(yarpy.Timeout):
            client.call("late", timeout=0.1)
        assert lasted(began) < 1.8
        peer.end()
        peer.begin("serve(1)")
        assert client.call("again", timeout=HANG) == ["ok", "again"], "not the late answer"
        peer.end()


def test_the_tools(network: CppYarp) -> None:
    """`yarp rpc` to our server, our client to `yarp rpcserver`."""
    with yarpy.RpcServer("/server", echo):
        answer = network.run("rpc", "/server", input='add 1 2\n[many] "x y"\n\n')
        assert answer.stdout == 'Response: ok add 1 2\nResponse: ok [many] "x y"\nResponse: ok\n'
        assert answer.returncode == 0
    with yarpy.RpcServer("/server", lambda message: [Vocab("many"), "one", "two words", 3]):
        answer = network.run("rpc", "/server", input="x\n")
        assert answer.stdout == "Responses:\n  one\n  two words\n  3\n"
    with network.popen("rpcserver", "/asked") as process:
        process.wait_line("Port /asked active")
        with yarpy.RpcClient("/asked") as client:
            process.write_line('fine "thank you" 5')
            assert client.call("how", "are", "you", timeout=HANG) == ["fine", "thank you", 5]
        process.stop()  # its output is block buffered: only now it says it all
        wait_until(lambda: "Message: how are you\nReply: " in process.stdout)
