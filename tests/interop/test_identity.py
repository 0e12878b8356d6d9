"""A number that a C++ name server hands out a second time leads nobody to the wrong port."""

import time
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.wait import HANG, wait_until

import yarpy

SETTLED = 3.0  # seconds in which a connection that is dialled again would be there long since


@pytest.fixture
def server(cpp: CppYarp) -> Iterator[CppYarp]:
    """A C++ server to be killed."""
    with cpp.server() as programs, configured_for(programs, by_file=True):
        yield programs


def test_a_camera_does_not_pour_into_a_motor(cpp: CppYarp, server: CppYarp) -> None:
    """The restarted server hands the number of the living /motor to the new /viewer."""
    assert server.server_process is not None
    with CppProgram(server) as motor, yarpy.Port("/camera") as camera:
        number = motor.do("port = yarp.BufferedPortBottle()\nport.open('/motor')\n"
                          "port.where().getPort()")  # fmt: skip
        with CppProgram(server) as viewer:
            viewer.do("port = yarp.BufferedPortBottle(); port.open('/viewer')")
            camera.connect("/viewer")
            server.server_process.kill()
            viewer.process.kill()
        with cpp.server(port=server.port) as again:
            wait_until(lambda: yarpy.query("/camera"))
            with CppProgram(again) as viewer:
                _use_numbers_before(again, number)
                assert not viewer.do("port = yarp.BufferedPortBottle(); port.open('/viewer')")
                found = yarpy.query("/viewer")
                assert found is not None and found.port == number, "the premise of this test"
                deadline = time.monotonic() + SETTLED
                while time.monotonic() < deadline:
                    camera.write(["a picture"])
                    time.sleep(0.01)
                # Who asks for its name is an input for as long as that takes.
                wait_until(lambda: motor.do("port.getInputCount()") == 0)
                assert motor.do("port.getPendingReads()") == 0
                with pytest.raises(yarpy.WrongPort, match='"/motor" listens'):
                    camera.connect("/viewer")
                with pytest.raises(yarpy.WrongPort, match='"/motor" listens'):
                    yarpy.connect("/camera", "/viewer")
            with yarpy.BufferedPort("/viewer") as viewer:
                assert camera.wait_for_outputs(timeout=HANG)
                assert viewer.wait_for_inputs(timeout=HANG)


def _use_numbers_before(programs: CppYarp, number: int) -> None:
    """Let the server hand out what comes before `number`."""
    names = yarpy.names.default.DEFAULT.current()  # type: ignore[attr-defined]
    while names.register("/filler").port < number - 1:
        pass


def test_a_question_does_not_reach_another_part(cpp: CppYarp, network: CppYarp) -> None:
    """A stale name, the number of which another server has."""
    code = """
import threading
class Answer(yarp.PortReader):
    def read(self, connection):
        request, reply = yarp.Bottle(), yarp.Bottle()
        if not request.read(connection):
            return False
        asked.append(request.toString())
        reply.addString(name)
        reply.write(connection.getWriter())
        return True
asked, name = [], {name!r}
answer = Answer()
server = yarp.Port()
server.setReader(answer)
server.open(name)
server.where().getPort()
"""
    with CppProgram(network) as arm:
        with CppProgram(network) as hand:
            hand.do(code.format(name="/identity/hand"))
            client = yarpy.RpcClient("/identity/hand")
            assert client.call("open") == ["/identity/hand"]
            hand.process.kill()
        number = arm.do(code.format(name="/identity/arm"))
        names = yarpy.names.default.DEFAULT.current()  # type: ignore[attr-defined]
        names.register("/identity/hand", "tcp", "127.0.0.1", number)
        names.set("/identity/hand", "process", 1)
        for _ in range(3):
            with pytest.raises(yarpy.YarpError):
                client.call("down")
        with pytest.raises(yarpy.WrongPort):
            yarpy.RpcClient("/identity/hand")
        assert arm.do("asked") == []
        client.close()


def test_a_living_cpp_port_keeps_its_name(network: CppYarp) -> None:
    """A second one fails to open and the first goes on; one that was killed is replaced at once."""
    with (
        CppProgram(network) as first,
        CppProgram(network) as second,
        yarpy.Port("/twin/out") as out,
    ):
        number = first.do("port = yarp.BufferedPortBottle(); assert port.open('/twin/in')\n"
                          "port.setStrict(); port.where().getPort()")  # fmt: skip
        assert not second.do("port = yarp.BufferedPortBottle(); port.open('/twin/in')")
        second.process.wait_line("address conflict")
        found = yarpy.query("/twin/in")
        assert found is not None and found.port == number
        out.connect("/twin/in")
        out.write(["still there"])
        assert first.do("port.read().toString()") == '"still there"'
        first.process.kill()
        assert second.do("port = yarp.BufferedPortBottle(); port.open('/twin/in')")
        second.do("port.setStrict()")
        wait_until(lambda: out.write(["here again"]) and second.do("port.getPendingReads()"))
        assert second.do("port.read().toString()") == '"here again"'


def test_a_cpp_port_is_dialled_again(network: CppYarp) -> None:
    """It says its name, so it is known again, by its name and at its address."""
    with yarpy.Port("/identity/out") as out:
        for target in ("/identity/in", None):
            with CppProgram(network) as reader:
                number = reader.do("port = yarp.BufferedPortBottle(); port.open('/identity/in')\n"
                                   "port.where().getPort()")  # fmt: skip
                name = target or f"/127.0.0.1:{number}"
                out.connect(name)
                wait_until(lambda: out._hub.outputs.links[0].route.peer == "/identity/in")
                reader.process.kill()
            wait_until(lambda: not (out.write(["anybody?"]) and out.outputs))
            with CppProgram(network) as reader:
                reader.do("port = yarp.BufferedPortBottle(); port.open('/identity/in')")
                if target is None and reader.do("port.where().getPort()") != number:
                    pytest.skip("the server hands out another number")
                assert out.wait_for_outputs(timeout=HANG)
                wait_until(lambda: reader.do("port.getInputCount()") == 1)
                out.disconnect(name)
