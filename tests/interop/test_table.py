"""The table of C++ YARP: each verb with either name server, each type over each carrier, both ways.

One program of C++ and one port of ours are the two ends of the rows of each direction; the program
has every carrier that the package of C++ YARP brings.
"""

from __future__ import annotations

import dataclasses
import socket
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from support.cpp import CppYarp
from support.cpp_carrier import needs
from support.cpp_types import CppTypes, types_program
from support.peer import brings
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, Image, Matrix, Property, Sound, Stamp, Vector, Vocab

# -- carriers and types ---------------------------------------------------------------------------

CARRIERS = (
    *("tcp", "fast_tcp", "udp", "mcast", "text", "text_ack"),
    *("shmem", "unix_stream", "tcpros"),
)
PLUGINS = ("shmem", "unix_stream", "tcpros")
RGB = np.array([[10 * y + x for x in range(15)] for y in range(3)], "u1").reshape(3, 5, 3)
MONO = np.array([[10 * y + x for x in range(5)] for y in range(3)], "u1")
SAMPLES = np.array([[100 * at - 250 for at in range(3)], [100 * at + 50 for at in range(3)]], "i2")
WORDS = [1, -2.5, "word", "two words", Vocab("set"), [3, ["deep"], []], b"b\0"]


def painted(array: Any) -> str:
    """An image as C++ shows it."""
    height, width = array.shape[:2]
    return f"{width}x{height} " + " ".join(str(n) for n in array.ravel())


#: as C++ names it: the value here, what it is read as, and how C++ shows it
TYPES: dict[str, tuple[Any, type, str]] = {
    "Bottle": (
        Bottle(WORDS),
        Bottle,
        '1 -2.5 word "two words" [set] (3 (deep) ()) {98 0}',
    ),
    "Value": ("two words", str, "two words"),
    "Property": (Property({"a": 5, "b": 2.5, "s": "x y"}), Property, "5 2.5 x y"),
    "Stamp": (Stamp(7, 5.25), Stamp, "7 5.250000"),
    "Vector": (Vector([0.5, -2.5, 0.25]), Vector, " 0.50\t-2.50\t 0.25"),
    "VectorInt": (np.array([5, -6], "i4"), np.ndarray, "5 -6"),
    "Matrix": (
        Matrix(np.arange(6.0).reshape(2, 3) / 8),
        Matrix,
        "2x3 0 0.125 0.25 0.375 0.5 0.625",
    ),
    "ImageRgb": (Image(RGB), Image, painted(RGB)),
    "ImageMono": (Image(MONO), Image, painted(MONO)),
    "Sound": (Sound(SAMPLES, 44100), Sound, "44100 " + " ".join(map(str, SAMPLES.ravel()))),
}
#: what C++ itself reads as text: of other types it wants the binary form there, too
TEXT_TO_CPP = set(TYPES) - {"Value", "Sound"}
#: what C++ itself writes as text: of other types it writes the binary form, or nothing
TEXT_FROM_CPP = {"Bottle", "Property", "Stamp"}


def rows(in_text: set[str]) -> list[tuple[str, str]]:
    return [
        (carrier, kind)
        for carrier in CARRIERS
        for kind in TYPES
        if kind in in_text or not carrier.startswith("text")
    ]


class Ends:
    """A port of a program of C++ and one of ours, connected by one carrier at a time.

    Each carrier has new ones: a reader of C++ over tcpros does not notice that its sender has left,
    and its port answers nobody from then on.
    """

    def __init__(self, programs: CppYarp, program: str, sends: bool) -> None:
        self._programs = programs
        self._start = lambda: programs.popen(program=program)
        self._sends = sends
        self._carrier = ""
        self._process: Process | None = None
        self.port: yarpy.Port
        self.peer: CppTypes

    def over(self, carrier: str) -> CppTypes:
        """The program of C++, once both are connected by this carrier."""
        if self._carrier != carrier:
            if carrier in PLUGINS:
                needs(self._programs, carrier)
            self.close()
            ours, theirs = ("/ours/out", "/cpp/in") if self._sends else ("/ours/in", "/cpp/out")
            self.port = yarpy.Port(ours)
            self._process = self._start()
            self.peer = CppTypes(self._process)
            assert self.peer.ask(f"open {theirs}") == "done"
            if self._sends:
                yarpy.connect(ours, theirs, carrier)
            else:
                assert self.peer.ask(f"join {carrier} {theirs} {ours}") == "done"
            assert self.peer.ask("wait") == "done"
            wait_until(lambda: self._links, what="our end is there, too")
            assert [link.carrier for link in self._links] == [carrier]
            self._carrier = carrier
        return self.peer

    @property
    def _links(self) -> list[yarpy.Connection]:
        return [*self.port.inputs, *self.port.outputs]

    def close(self) -> None:
        self._carrier = ""
        if self._process is not None:
            self._process.stop(grace=0)
            self._process = None
            self.port.close()


@pytest.fixture(scope="module")
@brings("g++")
def program(cpp: CppYarp) -> str:
    return types_program(cpp)


@pytest.fixture(scope="module")
def programs(our_names: CppYarp, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CppYarp]:
    """Programs that meet ours where sockets of this computer lie."""
    place = tmp_path_factory.mktemp("run")
    place.chmod(0o700)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARP_RUNTIME_DIR", str(place))
        yield dataclasses.replace(our_names, variables={"YARP_RUNTIME_DIR": str(place)})


@pytest.fixture(scope="module")
def to_cpp(programs: CppYarp, program: str) -> Iterator[Ends]:
    ends = Ends(programs, program, sends=True)
    yield ends
    ends.close()


@pytest.fixture(scope="module")
def from_cpp(programs: CppYarp, program: str) -> Iterator[Ends]:
    ends = Ends(programs, program, sends=False)
    yield ends
    ends.close()


@pytest.mark.parametrize(("carrier", "kind"), rows(TEXT_TO_CPP))
def test_a_type_to_cpp(cpp: CppYarp, to_cpp: Ends, carrier: str, kind: str) -> None:
    peer = to_cpp.over(carrier)
    value, _, shown = TYPES[kind]
    peer.begin(f"read {kind}")
    older = kind == "Sound" and cpp.version < (3, 9)  # which has another form of sounds
    assert to_cpp.port.write(value.to_bottle() if older else value) == 1
    assert peer.end() == shown


@pytest.mark.parametrize(("carrier", "kind"), rows(TEXT_FROM_CPP))
def test_a_type_from_cpp(from_cpp: Ends, carrier: str, kind: str) -> None:
    peer = from_cpp.over(carrier)
    value, read_as, shown = TYPES[kind]
    peer.begin(f"send {kind}")
    found = from_cpp.port.read(timeout=HANG).as_(read_as)
    assert peer.end() == shown
    if read_as is np.ndarray:
        assert found.dtype == value.dtype
        found, value = found.tolist(), value.tolist()
    assert found == value


# -- verbs of name servers ------------------------------------------------------------------------

END = "*** end of message\n"
AT = "ip 10.0.0.1 port 5 type tcp\n"
REGISTER = "register {0} tcp 10.0.0.1 5"
#: verb: what is asked before, what is asked, and the answer. `{0}` and `{1}` are two names.
VERBS: dict[str, tuple[list[str], str, str]] = {
    "register": ([], REGISTER, "registration name {0} " + AT + END),
    "query": ([REGISTER], "query {0}", "registration name {0} " + AT + END),
    "query nobody": ([], "query {0}", END),
    "bot query": (
        [REGISTER],
        "bot query {0}",
        'port (name "{0}") (ip "10.0.0.1") (port_number 5) (carrier tcp)\n',
    ),
    "bot query nobody": ([], "bot query {0}", 'port (error -2 "port not known")\n'),
    "unregister": ([REGISTER, "unregister {0}"], "query {0}", END),
    "list": ([REGISTER], "list {0}", "registration name {0} " + AT + END),
    "bot list": (
        [REGISTER],
        "bot list {0}",
        'ports (port (name "{0}") (ip "10.0.0.1") (port_number 5) (carrier tcp))\n',
    ),
    "set": ([REGISTER], "set {0} key a", "port {0} property key = a\n" + END),
    "get": ([REGISTER, "set {0} key a"], "get {0} key", "port {0} property key = a\n" + END),
    "check": (
        [REGISTER, "set {0} key a"],
        "check {0} key a",
        "port {0} property key value a present true\n" + END,
    ),
    "check another": (
        [REGISTER, "set {0} key a"],
        "check {0} key b",
        "port {0} property key value b present false\n" + END,
    ),
    "route": (
        [REGISTER, "register {1} tcp 10.0.0.1 6"],
        "route {0} {1}",
        "port {0} route {1} = tcp:/{1}\n" + END,
    ),
    "topic": ([], "topic {0}", "[ok]\n"),
    "untopic": (["topic {0}"], "untopic {0}", "[ok]\n"),
    "announce": ([REGISTER], "announce {0}", "[ok]\n"),
    "subscribe": ([], "subscribe {0} {1}", "[ok]\n"),
    "subscribe alone": (
        ["subscribe {0} {1}"],
        "subscribe {0}",
        'subscriptions (subscription (src "{0}") (dest "{1}"))\n',
    ),
    "unsubscribe": (
        ["subscribe {0} {1}", "unsubscribe {0} {1}"],
        "subscribe {0}",
        "subscriptions\n",
    ),
    "type": ([], "type {0}", "[fail]\n"),
    "runners": ([], "runners", END),
    "gc": ([], "gc", "garbage collection done.\n" + END),
    "unknown": ([], "bogus {0}", END),
}


def asked(programs: CppYarp, commands: list[str]) -> str:
    """The answer to the last of these."""
    with socket.create_connection((programs.host, programs.port), HANG) as connection:
        lines = connection.makefile("rb")
        connection.sendall(b"CONNACK admin\r\n")
        assert lines.readline() == b"Welcome admin\r\n"
        answer = ""
        for command in commands:
            connection.sendall(f"d\r\n{command}\r\n".encode())
            answer = ""
            while (line := lines.readline().decode()) != "<ACK>\r\n":
                assert line.endswith("\r\n"), f"the server hung up after: {command}"
                answer += line.replace("\r\n", "\n")
    return answer


@pytest.mark.parametrize("verb", VERBS)
def test_a_verb(network: CppYarp, verb: str) -> None:
    before, command, answer = VERBS[verb]
    names = [f"/{sorted(VERBS).index(verb)}/{end}" for end in ("a", "b")]
    found = asked(network, [each.format(*names) for each in [*before, command]])
    assert found == answer.format(*names)
