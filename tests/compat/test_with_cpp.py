"""Programs that use compat and programs that use C++ YARP's binding, talking to each other."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.peer import brings
from support.port import free_block
from support.wait import wait_until

import yarp
import yarpy


@pytest.fixture(scope="module", params=["yarpy_server", "cpp_server"])
@brings("cpp")
def peer(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[CppProgram]:
    """A program with the C++ binding, and this process with compat, at one name server."""
    cpp = CppYarp.prepare(tmp_path_factory.mktemp("cpp"))
    with contextlib.ExitStack() as stack:
        if request.param == "yarpy_server":
            server = stack.enter_context(yarpy.NameServer(free_block(200)))
            programs = stack.enter_context(cpp.at("127.0.0.1", server.port))
            stack.enter_context(configured_for(programs, by_file=False))
        else:
            programs = stack.enter_context(cpp.server())
            stack.enter_context(configured_for(programs, by_file=True))
        yield stack.enter_context(CppProgram(programs))


FILL = {
    "Bottle": "m.fromString('1 2.5 (a [b]) \"c d\"')",
    "Property": "m.put('a', 1); m.put('b', 2.5)",
    "Vector": "m.resize(3); m.zero(); m.set(1, 2.5)",
    "Sound": "m.resize(4, 2); m.set(7, 2, 1); m.setFrequency(8000)",
    "ImageRgb": "m.resize(5, 3); m.zero(); m.pixel(4, 2).g = 200",
    "ImageMono": "m.resize(5, 3); m.zero()",
    "ImageFloat": "m.resize(5, 3); m.zero()",
}
SHOW = {
    "Bottle": "m.toString()",
    "Property": "m.toString()",
    "Vector": "[m.get(0), m.get(1), m.size()]",
    "Sound": "[m.getSamples(), m.getChannels(), m.get(2, 1), m.getFrequency()]",
    "ImageRgb": "[m.width(), m.height(), m.pixel(4, 2).g]",
    "ImageMono": "[m.width(), m.height()]",
    "ImageFloat": "[m.width(), m.height()]",
}


def do(code: str) -> object:
    """As `CppProgram.do`, in this process."""
    space: dict[str, object] = {"yarp": yarp}
    *before, last = code.strip().splitlines()
    exec("\n".join(before), space)
    return eval(last, space)


@pytest.mark.parametrize("kind", FILL)
def test_what_one_writes_the_other_reads(kind: str, peer: CppProgram) -> None:
    reader = getattr(yarp, f"BufferedPort{kind}")()
    writer = getattr(yarp, f"BufferedPort{kind}")()
    assert reader.open("/ours/in") and writer.open("/ours/out")
    peer.do(
        f"inp, out = yarp.BufferedPort{kind}(), yarp.BufferedPort{kind}()\n"
        "assert inp.open('/theirs/in') and out.open('/theirs/out')\n"
        "inp.setStrict(); yarp.Network.setVerbosity(-1)"
    )
    try:
        shown = do(f"m = yarp.{kind}()\n{FILL[kind]}\n{SHOW[kind]}")
        assert yarp.Network.connect("/ours/out", "/theirs/in")
        wait_until(lambda: writer.getOutputCount() == 1)
        if kind != "Sound":  # sent as YARP 3.9 does, which 3.5 does not read
            exec(FILL[kind], {"m": writer.prepare()})
            writer.writeStrict()
            assert peer.do(f"m = inp.read()\n{SHOW[kind]}") == shown
        assert yarp.Network.connect("/theirs/out", "/ours/in")
        wait_until(lambda: reader.getInputCount() == 1)
        peer.do(f"m = out.prepare()\n{FILL[kind]}\nout.write(True)")
        assert eval(SHOW[kind], {"m": reader.read()}) == shown
    finally:
        reader.close()
        writer.close()
        peer.do("inp.close(); out.close()")


def test_questions_both_ways(peer: CppProgram) -> None:
    class Echo(yarp.PortReader):
        def read(self, connection: yarp.ConnectionReader) -> bool:
            command = yarp.Bottle()
            command.read(connection)
            writer = connection.getWriter()
            if writer is not None:
                command.addString("echoed")
                command.write(writer)
            return True

    echo, server, client, reply = Echo(), yarp.Port(), yarp.RpcClient(), yarp.Bottle()
    server.setReader(echo)
    assert server.open("/ours/server") and client.open("/ours/client")
    try:
        peer.do(
            "c = yarp.RpcClient(); c.open('/theirs/client'); c.addOutput('/ours/server')\n"
            "s = yarp.RpcServer(); s.open('/theirs/server')\n"
            "r = yarp.Bottle(); b = yarp.Bottle()"
        )
        assert peer.do("c.write(yarp.Bottle('hi'), r)\nr.toString()") == "hi echoed"
        assert client.addOutput("/theirs/server")
        peer.begin("s.read(b, True)\nb.addString('theirs')\ns.reply(b)")
        assert client.write(yarp.Bottle("ho"), reply) and reply.toString() == "ho theirs"
        assert peer.end() is True
    finally:
        server.close()
        client.close()
        peer.do("c.close(); s.close()")


def test_persistent_connections(peer: CppProgram) -> None:
    style = yarp.ContactStyle()
    style.persistent = True
    assert yarp.Network.connect("/later/out", "/later/in", style)
    inp, out = yarp.BufferedPortBottle(), yarp.Port()
    assert inp.open("/later/in") and out.open("/later/out")
    try:
        wait_until(lambda: out.getOutputCount() == 1, 20.0)
        assert out.write(yarp.Bottle("by itself")) and inp.read().toString() == "by itself"
        assert yarp.Network.disconnect("/later/out", "/later/in", style)
    finally:
        inp.close()
        out.close()
