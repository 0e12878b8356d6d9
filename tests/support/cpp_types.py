"""C++ YARP's ports with all of its carriers, and values of every type: tests/support/cpp_types.cpp.

program = types_program(cpp)                 # MissingPeer says why there is none
with names.popen(program=program) as process:
    peer = CppTypes(process)
    peer.ask("open /cpp")
"""

from pathlib import Path

from support.cpp import CppYarp
from support.cpp_link import linked
from support.process import Process
from support.wait import HANG

_SOURCE = Path(__file__).with_suffix(".cpp")
_CARRIERS = ("shmem", "tcpros", "unix_stream")


def types_program(cpp: CppYarp) -> str:
    """The program, for `popen(program=)`. Or MissingPeer."""
    source = _SOURCE.read_text("utf-8")
    return str(linked(cpp, "types", source, _CARRIERS, ["YARP_sig", "YARP_os", "YARP_init"]))


class CppTypes:
    """Asks such a program, line by line."""

    def __init__(self, process: Process) -> None:
        self._process = process
        self._lines = 0

    def begin(self, line: str) -> None:
        """Ask without waiting; `end` has to follow."""
        self._lines += 1
        self._process.write_line(line)

    def end(self, timeout: float = HANG) -> str:
        """The answer to what was begun."""
        answer = self._process.wait_line("", timeout=timeout, count=self._lines, stream="out")
        return answer.string

    def ask(self, line: str) -> str:
        """The answer to `line`."""
        self.begin(line)
        return self.end()
