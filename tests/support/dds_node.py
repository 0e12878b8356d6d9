"""A node of ROS 2 over DDS as rmw_cyclonedds_cpp makes one, with types of the library, which writes
and reads its messages itself: topics, services and ros_discovery_info.

python dds_node.py       does what the lines of its input say, each a list in JSON:

    ["serve", NAME]                 adds two numbers for whoever asks
    ["ask", NAME, A, B]             ... asks for it; answered by the sum, or null
    ["list", NODE]                  the names of its parameters
    ["goal", NAME, ORDER]           sends a goal of Fibonacci; its status and result
    ["nodes"]                       the nodes that programs tell of, with their readers and writers
    ["be", NAMESPACE, NAME]         tells of a node of its own
    ["rosout"]                      the texts of /rosout so far
    ["clock", SECONDS]              publishes /clock

Each is answered by ["done", VERB, ...].
"""

import json
import queue
import sys
import threading
import time
from dataclasses import dataclass
from typing import Any

from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, int8, int32, int64, sequence, uint8, uint32, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

RELIABLE = Policy.Reliability.Reliable(duration(milliseconds=100))
WAIT = 20.0  # seconds for whatever is asked


def pair(package: str, name: str, asked: dict[str, Any], answered: dict[str, Any]) -> Any:
    """The classes of a service: the header of the middleware, then the fields."""
    found = []
    for half, fields in (("Request", asked), ("Response", answered)):
        given = {"guid": uint64, "seq": int64, **fields}
        space = {"__annotations__": given}
        typename = f"{package}.dds_.{name}_{half}_"
        made = type(f"{name}_{half}_", (IdlStruct,), space, typename=typename)
        found.append(dataclass(made))
    return found


@dataclass
class Gid(IdlStruct, typename="rmw_dds_common.msg.dds_.Gid_"):
    data: array[uint8, 16]


@dataclass
class NodeInfo(IdlStruct, typename="rmw_dds_common.msg.dds_.NodeEntitiesInfo_"):
    node_namespace: str
    node_name: str
    reader_gid_seq: sequence[Gid]
    writer_gid_seq: sequence[Gid]


@dataclass
class Info(IdlStruct, typename="rmw_dds_common.msg.dds_.ParticipantEntitiesInfo_"):
    gid: Gid
    node_entities_info_seq: sequence[NodeInfo]


@dataclass
class ListResult(IdlStruct, typename="rcl_interfaces.msg.dds_.ListParametersResult_"):
    names: sequence[str]
    prefixes: sequence[str]


@dataclass
class Uuid(IdlStruct, typename="unique_identifier_msgs.msg.dds_.UUID_"):
    uuid: array[uint8, 16]


@dataclass
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Clock(IdlStruct, typename="rosgraph_msgs.msg.dds_.Clock_"):
    clock: Time


@dataclass
class Log(IdlStruct, typename="rcl_interfaces.msg.dds_.Log_"):
    stamp: Time
    level: uint8
    name: str
    msg: str
    file: str
    function: str
    line: uint32


@dataclass
class Goal(IdlStruct, typename="example_interfaces.action.dds_.Fibonacci_Goal_"):
    order: int32


@dataclass
class Result(IdlStruct, typename="example_interfaces.action.dds_.Fibonacci_Result_"):
    sequence: sequence[int32]


ADD = pair("example_interfaces.srv", "AddTwoInts", {"a": int64, "b": int64}, {"sum": int64})
LIST = pair(
    "rcl_interfaces.srv",
    "ListParameters",
    {"prefixes": sequence[str], "depth": uint64},
    {"result": ListResult},
)
SEND = pair(
    "example_interfaces.action",
    "Fibonacci_SendGoal",
    {"goal_id": Uuid, "goal": Goal},
    {"accepted": bool, "stamp": Time},
)
GET = pair(
    "example_interfaces.action",
    "Fibonacci_GetResult",
    {"goal_id": Uuid},
    {"status": int8, "result": Result},
)


def knows_all(writer: Any, reader: Any) -> bool:
    """Whether a server knows where answers go to, for all who ask it: as rmw_cyclonedds_cpp it
    waits for that."""
    return len(writer.get_matched_subscriptions()) >= len(reader.get_matched_publications())


class Node:
    def __init__(self) -> None:
        self.part = DomainParticipant(0, qos=Qos(Policy.Userdata(b"enclave=/;")))
        self.held: list[Any] = []
        self.served: list[tuple[Any, Any]] = []
        self.count = 0
        told = Qos(RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepAll)
        topic = Topic(self.part, "ros_discovery_info", Info)
        self.tells = DataWriter(self.part, topic, qos=told)
        self.hears = DataReader(self.part, topic, qos=told)
        self.known: dict[bytes, Any] = {}
        log = Topic(self.part, "rt/rosout", Log)
        self.logs = DataReader(self.part, log, qos=told)
        clock: Any = Topic(self.part, "rt/clock", Clock)
        self.clock = DataWriter(self.part, clock, qos=Qos(Policy.Reliability.BestEffort))

    def ends(self, name: str, types: Any, serves: bool, about: bytes) -> tuple[Any, Any]:
        qos = Qos(RELIABLE, Policy.History.KeepLast(10), Policy.Userdata(about))
        asks: Any = Topic(self.part, f"rq{name}Request", types[0])
        answers: Any = Topic(self.part, f"rr{name}Reply", types[1])
        out, into = (answers, asks) if serves else (asks, answers)
        found = DataWriter(self.part, out, qos=qos), DataReader(self.part, into, qos=qos)
        self.held += [asks, answers]
        return found

    def ask(self, name: str, types: Any, **fields: Any) -> Any:
        writer, reader = self.ends(name, types, False, b"clientid=1.2.3;")
        deadline = time.monotonic() + WAIT
        while not (writer.get_matched_subscriptions() and reader.get_matched_publications()):
            if time.monotonic() > deadline:
                return None
            self.step()
        self.count += 1
        who = writer.get_instance_handle() & ((1 << 64) - 1)
        writer.write(types[0](guid=who, seq=self.count, **fields))
        while time.monotonic() < deadline:
            for sample in reader.take(N=10):
                if not isinstance(sample, types[1]):
                    continue
                if (sample.guid, sample.seq) == (who, self.count):
                    return sample
            self.step()
        return None

    def step(self) -> None:
        for writer, reader in self.served:
            for sample in reader.take(N=10):
                if not isinstance(sample, ADD[0]):
                    continue  # somebody has gone
                answer = ADD[1](guid=sample.guid, seq=sample.seq, sum=sample.a + sample.b)
                until = time.monotonic() + WAIT
                while not knows_all(writer, reader) and time.monotonic() < until:
                    time.sleep(0.005)
                writer.write(answer)
        time.sleep(0.005)

    def do(self, verb: str, *words: Any) -> Any:
        if verb == "serve":
            self.served.append(self.ends(words[0], ADD, True, b"serviceid=7.8.9;"))
        elif verb == "ask":
            answer = self.ask(words[0], ADD, a=words[1], b=words[2])
            return None if answer is None else answer.sum
        elif verb == "list":
            name = f"{words[0]}/list_parameters"
            answer = self.ask(name, LIST, prefixes=[], depth=0)
            return None if answer is None else answer.result.names
        elif verb == "goal":
            this = Uuid(list(range(16)))
            sent = self.ask(
                f"{words[0]}/_action/send_goal", SEND, goal_id=this, goal=Goal(words[1])
            )
            got = self.ask(f"{words[0]}/_action/get_result", GET, goal_id=this)
            return [sent and sent.accepted, got and got.status, got and got.result.sequence]
        elif verb == "nodes":
            for sample in self.hears.take(N=1000):
                if isinstance(sample, Info):
                    self.known[bytes(sample.gid.data)] = sample.node_entities_info_seq
            return [
                [
                    node.node_namespace,
                    node.node_name,
                    len(node.reader_gid_seq),
                    len(node.writer_gid_seq),
                ]
                for nodes in self.known.values()
                for node in nodes
            ]
        elif verb == "be":
            ours = Gid(list(self.part.guid.bytes))
            node = NodeInfo(words[0], words[1], [], [Gid(list(self.clock.guid.bytes))])
            self.tells.write(Info(ours, [node]))
        elif verb == "rosout":
            return [[item.level, item.name, item.msg] for item in self.logs.read(N=100_000)]
        elif verb == "clock":
            self.clock.write(Clock(Time(words[0], 0)))
        return None


def main() -> None:
    node = Node()
    lines: queue.Queue[str] = queue.Queue()

    def read() -> None:  # a thread: Windows waits for sockets alone
        for line in sys.stdin:
            lines.put(line)
        lines.put("")

    threading.Thread(target=read, daemon=True).start()
    print(json.dumps("ready"), flush=True)
    while True:
        try:
            line = lines.get_nowait()
        except queue.Empty:
            node.step()
            continue
        if not line:
            return
        words = json.loads(line)
        try:
            answer = node.do(*words)
        except DDSException as error:
            answer = str(error)
        print(json.dumps(["done", words[0], answer]), flush=True)


if __name__ == "__main__":
    main()
