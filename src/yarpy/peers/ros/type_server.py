"""The type server: tells programs on the network what types of ROS look like, and is asked.

    > twiddle turtlesim/Pose        < vector float32 5 *      what C++ YARP translates with
    > raw turtlesim/Pose            < float32 x ...           the text of the file

Rules: the questions and answers of `yarpidl_rosmsg`: a string each, over ROS as a service of the
type test_roscpp/TestStringString, over YARP as a Bottle of a string or of separate words. "" stands
for a type that nobody has, "?" for what no answer can be given to. Whoever asks keeps what it
learns. Source: idl section B.5.
"""

from __future__ import annotations

from typing import Final

from yarpy import fork
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import DecodeError, UnknownType, YarpError
from yarpy.limit import ROS_TEXT
from yarpy.names.base import NameClient
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.message.library import Library, default_library
from yarpy.peers.ros.message.template import UNKNOWN, template
from yarpy.peers.ros.names import RosNames
from yarpy.port.connect.probe import Caller
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message

SERVICE: Final = "/typ"
TYPE: Final = "test_roscpp/TestStringString"
TIMEOUT: Final = 3.0  # seconds for an answer
HINT: Final = f"the type server {SERVICE} (`yarpy idl rosmsg --name {SERVICE}@/yarpros` starts one)"


class TypeServer:
    """Answers from a library. The names of C++ are `/typ@/yarpros` and, without ROS, `/typ`.

    Raises AddressError, NoNameServer.
    """

    def __init__(
        self, name: str, library: Library | None = None, names: NameClient | None = None
    ) -> None:
        self._library = default_library() if library is None else library
        self._port = RpcServer(name, self._answer, names=names, port_type=TYPE)

    @property
    def name(self) -> str:
        """The name of its port."""
        return self._port.name

    def _answer(self, message: Message) -> Bottle:
        words = " ".join(map(plain_text, message.as_(Bottle))).split()
        return Bottle([self.tell(words)])

    def tell(self, words: list[str]) -> str:
        """The answer to a question."""
        if len(words) != 2 or words[0] not in ("twiddle", "raw"):
            return UNKNOWN
        verb, name = words
        catalogue = self._library.catalogue
        for kind in ("msg", "srv"):
            try:
                if verb == "raw":
                    return catalogue.text(name, kind).text
                found = catalogue.message(name) if kind == "msg" else catalogue.service(name)
                return template(found)
            except UnknownType:
                continue
            except DecodeError:
                return UNKNOWN
        return ""

    def close(self) -> None:
        """Close its port."""
        self._port.close()


class TypeClient:
    """A source of definitions for a library: the type server that a name service knows."""

    def __init__(self, names: NameClient) -> None:
        self._names = names

    def find(self, name: str, kind: str) -> str | None:
        """The text of a type; None if no server is there, or it does not know."""
        try:
            where = self._names.query(SERVICE)
            if where is None:
                return None
            with Caller(where, "/yarpy_types", timeout=TIMEOUT) as caller:
                answer = caller.ask([f"raw {name}"], TIMEOUT)
        except (YarpError, OSError):
            return None
        words = answer.as_(Bottle) if answer is not None else Bottle()
        text = plain_text(words[0]) if words and isinstance(words[0], str) else ""
        if text in ("", UNKNOWN) or len(text) > ROS_TEXT:
            return None
        is_service = any(line.startswith("---") for line in text.split("\n"))
        return text if is_service == (kind == "srv") else None

    def __str__(self) -> str:
        return HINT


_asked: Final[set[str]] = set()  # masters whose type servers are among the sources
_lock: Final = fork.lock()


def ask_type_server(master: RosMaster) -> None:
    """Let this process's library ask the type server of a graph for what it has not."""
    with _lock:
        if master.uri not in _asked:
            _asked.add(master.uri)
            default_library().catalogue.sources.append(TypeClient(RosNames(master)))
