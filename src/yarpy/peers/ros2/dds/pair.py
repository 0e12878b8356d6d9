"""The reader and the writer of a service over DDS, as rmw_cyclonedds_cpp has them.

    rq/addRequest, rr/addReply          the topics of /add
    uint64 who | int64 number | ...     what stands in front of each question, and of its answer

Rules: a question names its writer, by a number that is the library's, and is numbered; its answer
has the same. Both halves of a client, or of a server, say in their QoS that they belong together,
so that who asks can wait until both know it; a server that knows a client's writer before its
reader waits with the answer, which would go nowhere. rmw_fastrtps_cpp says all this elsewhere,
where the library does not let us read it: its services are not reached.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from struct import Struct
from time import monotonic, sleep
from typing import Any, Final, NamedTuple

from yarpy.errors import UnknownName, UnknownType
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.dds.apart import WHY, apart_by
from yarpy.peers.ros2.dds.library import delete, load, turn
from yarpy.peers.ros2.dds.participant import Participant
from yarpy.peers.ros2.dds.qos import dds_qos
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.message.hash import ros_name
from yarpy.peers.ros2.message.library import default_library, hash_of
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.token import SUBSCRIBER

ROOM: Final = 100  # questions or answers that the library keeps until they are taken
FAST_DDS: Final = b"\x01\x0f"  # so begin the identities of its endpoints
MEETING: Final = 2.0  # seconds for the reader of a client whose writer is known
LOOK: Final = 0.005  # seconds between looks for it
MOST_MET: Final = 1000  # writers of clients that are remembered

_UNSIGNED: Final = (1 << 64) - 1
_ENCAPSULATION: Final = 4
_HEADER: Final = Struct("<Qq")
_SERVER = re.compile(rb"serviceid=([0-9a-fA-F.]+);")
_CLIENT = re.compile(rb"clientid=([0-9a-fA-F.]+);")
_numbers = itertools.count(1)


class ServiceSample(NamedTuple):
    """A question or answer: whose, which, and its bytes, as those of a message; `writer`: the
    library's handle of who wrote it, here."""

    who: int
    number: int
    body: bytes
    time: int
    writer: int = 0


def topics(name: str) -> tuple[str, str]:
    """Return where questions to a service go, and where answers come.

    >>> topics("/add")
    ('rq/addRequest', 'rr/addReply')
    """
    return f"rq{name}Request", f"rr{name}Reply"


def joined(who: int, number: int, body: bytes) -> bytes:
    """Return the bytes of a question or answer."""
    return body[:_ENCAPSULATION] + _HEADER.pack(who, number) + body[_ENCAPSULATION:]


def parted(body: bytes, time: int, writer: int = 0) -> ServiceSample | None:
    """Return what came; None for what is no question or answer."""
    if len(body) < _ENCAPSULATION + _HEADER.size or body[:2] != b"\0\1":
        return None
    who, number = _HEADER.unpack_from(body, _ENCAPSULATION)
    content = body[:_ENCAPSULATION] + body[_ENCAPSULATION + _HEADER.size :]
    return ServiceSample(who, number, content, time, writer)


def type_of(part: Participant, name: str, said: str) -> Any:
    """Return the type of a service: the one that is said, else the one of who serves it. Raises
    UnknownName, UnknownType, DecodeError."""
    if said:
        return kinds.named(said, kinds.SERVICE)
    asked, _ = topics(name)
    for item in part.endpoints(SUBSCRIBER):
        if item.topic_name == asked:
            found, kind = ros_name(item.type_name.removesuffix("_Request_") + "_")
            if kind != kinds.SERVICE:
                raise UnknownType(f"{name} is served as {item.type_name}, which is no service")
            return default_library().service(found)
    raise UnknownName(
        f"nobody serves {name} over DDS in domain {part.number}: name its type to be there first: "
        f"ros2+dds+srv:/{name}~package/srv/Type"
    )


class Pair:
    """Both halves for `kind`, a service; `take(sample)` is called in a thread of DDS, `changed`
    when somebody comes or goes."""

    def __init__(
        self,
        part: Participant,
        node: Node,
        name: str,
        kind: Any,
        qos: Qos,
        serves: bool,
        hear: Callable[[ServiceSample], None],
        changed: Callable[[], None] = lambda: None,
    ) -> None:
        from cyclonedds import pub, sub, topic

        self.part, self.node, self.name, self.kind = part, node, name, kind
        self._hear, self._changed, self._closed = hear, changed, False
        self._key: Key = kinds.key_of(part.number, name, kind, False)
        identity = part.dds.guid.bytes[:12] + next(_numbers).to_bytes(4, "big")
        word = "serviceid" if serves else "clientid"
        about = f"{word}={'.'.join(format(item, 'x') for item in identity)};"
        asked, answered = topics(name)
        halves = [(answered, kind.Response), (asked, kind.Request)]
        (out, wrote), (into, read) = halves if serves else reversed(halves)
        self._class = part.class_of(wrote, "srv")
        self._topics = [
            topic.Topic(part.dds, out, self._class),
            topic.Topic(part.dds, into, part.class_of(read, "srv")),
        ]
        written = dds_qos(qos, hash_of(wrote), ROOM, writes=True, about=about)
        self.writer: Any = pub.DataWriter(part.dds, self._topics[0], qos=written)
        heard = dds_qos(qos, hash_of(read), ROOM, writes=False, about=about)
        self.reader: Any = sub.DataReader(part.dds, self._topics[1], qos=heard)
        status = load().DDSStatus
        self.reader.set_status_mask(status.DataAvailable | status.SubscriptionMatched)
        self._matched = status.SubscriptionMatched
        self._met: set[int] = set()  # writers of clients whose readers know us
        self.who: int = self.writer.get_instance_handle() & _UNSIGNED
        part.discovery.add(node, readers=(self.reader,), writers=(self.writer,))
        part.pump.add(self.reader, self._take)

    def write(self, who: int, number: int, body: bytes) -> None:
        """Send a question or answer."""
        sample = self._class.__new__(self._class)
        sample.body = joined(who, number, body)
        self.writer.write(sample)

    def answer(self, sample: ServiceSample, body: bytes) -> None:
        """Send the answer to a question, once its asker can hear it."""
        if sample.writer not in self._met:
            end = monotonic() + MEETING
            while not self._is_met(sample.writer) and monotonic() < end:
                sleep(LOOK)
            if len(self._met) >= MOST_MET:
                self._met.clear()
            self._met.add(sample.writer)
        self.write(sample.who, sample.number, body)

    def _is_met(self, writer: int) -> bool:
        """Return whether we know the reader of a client; True if the client has gone."""
        try:
            with turn:
                asks = None if self._closed else self.reader.get_matched_publication_data(writer)
        except load().DDSException:
            return True
        if asks is None:
            return True
        said = _CLIENT.search(_userdata(asks.qos))
        for item in self._matching(self.writer, "subscription"):
            if item.participant_key == asks.participant_key:
                found = _CLIENT.search(_userdata(item.qos))
                if said is None or (found is not None and found[1] == said[1]):
                    return True
        return False

    def _take(self) -> Callable[[], None] | None:
        news = self.reader.take_status(self._matched)
        found = []
        for sample in self.reader.take(N=ROOM):
            body, info = getattr(sample, "body", None), sample.sample_info
            time = int(info.source_timestamp)
            sample = None if body is None else parted(body, time, info.publication_handle)
            if sample is not None:
                found.append(sample)
        if not found and not news:
            return None

        def act() -> None:
            for each in found:
                self._hear(each)
            if news:
                self._changed()

        return act

    def servers(self) -> frozenset[bytes]:
        """Return the servers that know both halves of ours, and we both of theirs: the identities
        of their readers."""
        said: dict[bytes, bytes] = {}
        plain: dict[bytes, Any] = {}  # of programs that do not say which halves belong together
        for item in self._matching(self.writer, "subscription"):
            key = item.key.bytes
            if key[:2] == FAST_DDS:
                continue
            found = _SERVER.search(_userdata(item.qos))
            if found is None:
                plain[key] = item.participant_key
            else:
                said[key] = found[1]
        answers = self._matching(self.reader, "publication")
        if not said:
            programs = {item.participant_key for item in answers}
            return frozenset(key for key, program in plain.items() if program in programs)
        ids = {found[1] for item in answers if (found := _SERVER.search(_userdata(item.qos)))}
        return frozenset(key for key, id_ in said.items() if id_ in ids)

    def why_not(self) -> str:
        """Return why nobody is asked."""
        asked, _ = topics(self.name)
        for item in () if self._closed else self.part.endpoints(SUBSCRIBER):
            if item.topic_name != asked:
                continue
            if item.key.bytes[:2] == FAST_DDS:
                return (
                    f"{self.name} is served with Fast DDS, whose services are not reached from "
                    "here: start its node with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp"
                )
            if item.type_name != self._key.type[:-1] + "_Request_":
                return f"{self.name} is served as {item.type_name}, not as {kinds.shown(self._key)}"
            if policy := apart_by(item, self._class):
                why, remedy = WHY[policy]
                return f"{self.name} is served as a type of the same name, but {why}; {remedy}"
        return f"nobody serves {self.name} as {kinds.shown(self._key)}"

    def _matching(self, half: Any, what: str) -> list[Any]:
        if self._closed:
            return []
        found = []
        for handle in getattr(half, f"get_matched_{what}s")():
            try:
                with turn:
                    found.append(getattr(half, f"get_matched_{what}_data")(handle))
            except load().DDSException:
                continue  # it has just gone
        return [item for item in found if item is not None]

    def close(self) -> None:
        """Idempotent."""
        if self._closed:
            return
        self._closed = True
        self.part.pump.remove(self.reader)
        self.part.discovery.remove(self.node, self.reader, self.writer)
        for item in (self.reader, self.writer, *self._topics):
            delete(item)


def _userdata(qos: Any) -> bytes:
    for policy in qos:
        if type(policy).__name__ == "Userdata":
            data: bytes = policy.data
            return data
    return b""
