"""The C++ peer alone: if these fail, an interoperation test says nothing about yarpy."""

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram


def test_programs_and_binding_are_the_known_version(cpp: CppYarp) -> None:
    assert cpp.version in ((3, 5), (3, 9), (4, 0))
    assert cpp.python("import yarp; print(yarp.Bottle('1 (a b) 2.5').size())").stdout == "3\n"


def test_nothing_is_configured_without_a_server(cpp: CppYarp) -> None:
    answer = cpp.run("where")
    assert answer.returncode == 1
    assert "No address for a YARP name server is available" in answer.stdout


def test_server_is_on_the_loopback(cpp_server: CppYarp) -> None:
    listing = cpp_server.run("name", "list").stdout
    assert f"registration name /root ip 127.0.0.1 port {cpp_server.port} type tcp\n" in listing
    assert cpp_server.run("where").returncode == 0


def test_two_servers_are_strangers(cpp: CppYarp) -> None:
    with cpp.server() as here, cpp.server() as there, here.popen("read", "/only-here") as reader:
        reader.wait_line("Port /only-here active")
        assert here.run("exists", "/only-here").returncode == 0
        assert there.run("exists", "/only-here").returncode == 1


def test_write_to_read(cpp_server: CppYarp) -> None:
    with cpp_server.popen("read", "/reader") as reader:
        reader.wait_line("Port /reader active at tcp://127.0.0.1:")
        sent = cpp_server.run("write", "/writer", "/reader", input='1 2.5 "a b" (c d)\n')
        assert sent.returncode == 0
        reader.wait_line(r'^1 2\.5 "a b" \(c d\)$', stream="out")


def test_rpc(cpp_server: CppYarp) -> None:
    with cpp_server.popen("rpcserver", "--echo", "/service") as service:
        service.wait_line("Port /service active")
        answer = cpp_server.run("rpc", "/service", input="add 1 2\n")
        assert answer.stdout == "Response: add 1 2\n"
        assert answer.returncode == 0


def test_binding_moves_an_image(cpp_server: CppYarp) -> None:
    script = """
import yarp
yarp.Network.init()
source, sink = yarp.Port(), yarp.BufferedPortImageMono()
assert source.open("/source") and sink.open("/sink")
assert yarp.Network.connect("/source", "/sink", "fast_tcp")
pixels = bytearray(range(256)) * 4
image = yarp.ImageMono()
image.setExternal(memoryview(pixels), 64, 16)
assert source.write(image)
received = sink.read()
print("image", received.width(), received.height(), received.getRawImageSize())
"""
    answer = cpp_server.python(script)
    assert answer.returncode == 0, answer.stderr
    assert "image 64 16 1024\n" in answer.stdout


def test_ended_programs_leave_nothing(cpp: CppYarp) -> None:
    with cpp.server() as names, names.popen("read", "/gone") as reader:
        reader.wait_line("Port /gone active")
    assert reader.returncode is not None
    assert names.server_process is not None
    assert names.server_process.returncode is not None
    assert not names.home.exists()


def test_a_program_does_what_it_is_told(cpp_server: CppYarp) -> None:
    with CppProgram(cpp_server) as program:
        program.do("count = 1")
        program.begin("time.sleep(0.1); count += 1\n[count, 'done']")
        assert program.end() == [2, "done"]
        assert program.do("port = yarp.Port(); port.open('/mine')") is True
        assert program.do("yarp.Network.queryName('/mine').getCarrier()") == "tcp"
        with pytest.raises(AssertionError, match="ZeroDivisionError"):
            program.do("1 / 0")
        assert program.do("count") == 2
    assert program.process.returncode is not None
