"""tcpros between ports of ours and of C++ YARP, without ROS and without a type."""

import pytest
from support.cpp import CppYarp
from support.cpp_carrier import carrier_program
from support.peer import brings
from support.wait import HANG, wait_until

import yarpy


@pytest.fixture(scope="module")
@brings("g++")
def program(cpp: CppYarp) -> str:
    return carrier_program(cpp, "tcpros")


def test_a_cpp_reader_of_a_port_without_a_type(our_names: CppYarp, program: str) -> None:
    """It exits where a type is named that it cannot look up."""
    with yarpy.Port("/talk") as port, our_names.popen("read", "/listen", program=program) as peer:
        peer.wait_line("Port /listen active")
        yarpy.connect("/talk", "/listen", "tcpros")
        wait_until(lambda: port.outputs, what="the connection is there")
        for number in range(3):
            port.write(["hello", number])
        for number in range(3):
            peer.wait_line(f"^hello {number}$", stream="out")
        assert peer.returncode is None


def test_a_cpp_writer_to_a_port_without_a_type(our_names: CppYarp, program: str) -> None:
    with yarpy.Port("/ours") as port, our_names.popen("write", "/cpp", program=program) as peer:
        peer.wait_line("Port /cpp active")
        said = our_names.run("connect", "/cpp", "/ours", "tcpros", program=program)
        assert "Success" in said.stdout, said
        for number in range(3):
            peer.write_line(f"hello {number}")
            assert port.read(timeout=HANG).value == ["hello", number]
        assert peer.returncode is None
