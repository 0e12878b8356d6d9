"""A node of ROS 2 in a Python program: topics, services, parameters, actions.

    with yarpy.ros2.Node("/adder", parameters={"gain": 2}) as node:
        node.service("/add", "example_interfaces/srv/AddTwoInts", lambda asked: [asked.a + asked.b])
        node.publisher("/chatter", "std_msgs/msg/String").write("hello")
        node.subscriber("/cmd_vel", "geometry_msgs/msg/Twist", print)
        print(node.parameters_of("/other").all())

Rules: it speaks with nodes whose middleware is rmw_zenoh, over the router of this computer or of
YARPY_ZENOH, and opens no socket that others could dial; or, with `rmw="dds"`, with those that use
DDS. What is written, asked and answered is an object of the type, or a list or dict of its fields;
what comes is an object. Callbacks run in threads of the node: those of a topic or service one after
the other. Everything is safe to call from any thread. What `ros2 run` and `ros2 launch` say on the
command line of the program holds for all its nodes.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Self, TypeVar

from yarpy.errors import AddressError, DecodeError, LinkClosed, LocalProtocolError
from yarpy.log import logger
from yarpy.peers.ros2.action.client import ActionClient
from yarpy.peers.ros2.action.server import ActionServer, Goal
from yarpy.peers.ros2.action.status import (
    CANCEL_TYPE,
    STATUS_QOS,
    STATUS_TYPE,
    place,
)
from yarpy.peers.ros2.event import Event
from yarpy.peers.ros2.exchange import Question, Worker
from yarpy.peers.ros2.key import domain as domain_of
from yarpy.peers.ros2.message.library import default_library
from yarpy.peers.ros2.name import check_node
from yarpy.peers.ros2.node import logger_level, rosout
from yarpy.peers.ros2.node.arguments import expand, parse_arguments
from yarpy.peers.ros2.node.describer import TYPE as DESCRIBED
from yarpy.peers.ros2.node.describer import Describer
from yarpy.peers.ros2.node.logger_level import LoggerLevels
from yarpy.peers.ros2.node.sim_time import CLOCK, CLOCK_QOS, NodeTime
from yarpy.peers.ros2.parameter.client import RemoteParameters
from yarpy.peers.ros2.parameter.server import EVENT, EVENTS, QOS, SERVICES, Asked, event
from yarpy.peers.ros2.parameter.store import Change, Parameters
from yarpy.peers.ros2.qos import Qos, profile
from yarpy.peers.ros2.rmw import Answerer, Caller, Reader, Rmw, Writer

log = logger("yarpy.ros2")

C = TypeVar("C")
SIMULATED: Final = "use_sim_time"  # the parameter that every node has
MIDDLEWARE: Final = "RMW_IMPLEMENTATION"
DDS_TOO: Final = f"Where the nodes of ROS 2 speak DDS, set {MIDDLEWARE}=rmw_cyclonedds_cpp"


class Node:
    """A node called `name`, with a namespace or without. `domain`: of ROS 2, else ROS_DOMAIN_ID.
    `parameters`: those that it begins with. `rmw`: zenoh or dds, else what RMW_IMPLEMENTATION says,
    else zenoh. `arguments`: a command line with `--ros-args`, else that of this program.
    `enable_logger_service`: others may see and set the level of its log. Raises AddressError,
    UnknownPlugin, LinkClosed (no router); TypeError, ValueError for a parameter that the command
    line sets to what it cannot be."""

    def __init__(
        self,
        name: str,
        *,
        domain: int | None = None,
        parameters: Mapping[str, Any] | None = None,
        rmw: str | None = None,
        arguments: Sequence[str] | None = None,
        enable_logger_service: bool = False,
    ) -> None:
        self._said = parse_arguments(sys.argv if arguments is None else arguments)
        self._node = self._said.node(check_node(name))
        self._domain = domain_of(None if domain is None else str(domain))
        self._held: list[Any] = []
        self._callers: dict[tuple[str, str], Caller] = {}
        self._closed = False
        self._rmw = self._keep(chosen(rmw)(self._node, self._domain))
        self._worker = self._keep(Worker(f"yarpy node {self.name}"))
        self._describer = Describer()
        self.logger = rosout.node_logger(self._node, self._said.log_level)
        self.parameters = Parameters(given=self._said.parameters_of(self._node))
        self._time = NodeTime(self._hear_clock)
        try:
            for key, value in {SIMULATED: False, **(parameters or {})}.items():
                self.parameters.declare(key, value)
            self._time.follow(self.parameters.get(SIMULATED) is True)
            if self._said.rosout:
                out = self.publisher(rosout.TOPIC, rosout.TYPE, qos=rosout.QOS)
                self.logger.addHandler(rosout.Rosout(out.write))
            self._events = self.publisher(EVENTS, EVENT, qos=QOS)
            asked = Asked(self.parameters)
            for service, type_ in SERVICES.items():
                handler = asked.handlers[service]
                self._answer(f"{self.name}/{service}", type_, handler, self._worker, QOS)
            if enable_logger_service:
                levels = LoggerLevels(self.logger)
                for service, type_ in logger_level.SERVICES.items():
                    handler = levels.handlers[service]
                    self._answer(f"{self.name}/{service}", type_, handler, self._worker, None)
            describe, name_ = self._describer.answer, f"{self.name}/get_type_description"
            self._answer(name_, DESCRIBED, describe, self._worker, None)
        except BaseException as error:
            self.close()
            if isinstance(error, LinkClosed) and not is_said(rmw):
                raise LinkClosed(f"{error}. {DDS_TOO}") from error
            raise
        self.parameters._told = self._tell
        self.parameters.watch(self._watch)
        self._tell(Change(new={key: self.parameters.get(key) for key in self.parameters}))

    @property
    def name(self) -> str:
        """The whole name."""
        return str(self._node)

    def resolve(self, name: str, kind: str = "rostopic") -> str:
        """Return the full name of a topic, or of a service, `kind` being "rosservice": `~/x` is
        below the node's own name, `x` beside the node; or what the command line has in its place.
        Raises AddressError."""
        return self._said.remap(expand(name, self._node), self._node, kind)

    def now(self) -> float:
        """The time in seconds: the computer's, or what /clock said last, where the parameter
        `use_sim_time` is true; 0 before the first."""
        return self._time.now()

    # -- topics -----------------------------------------------------------------------------------

    def publisher(
        self,
        topic: str,
        type_: str,
        *,
        qos: str | Qos | None = None,
        on_event: Callable[[Event], object] | None = None,
    ) -> Writer:
        """Publish a topic: `publisher.write(value)`. `qos`: default, sensor, latched, all, or what
        `yarpy.ros2.qos_profile` makes. `on_event` hears of what happens to it. Raises AddressError,
        UnknownType."""
        self._check()
        made = self._used(self._rmw.writer(self.resolve(topic), type_, _qos(qos)))
        made.now = self.now
        made.events.hear = on_event
        return made

    def subscriber(
        self,
        topic: str,
        type_: str,
        callback: Callable[[Any], object],
        *,
        qos: str | Qos | None = None,
        on_event: Callable[[Event], object] | None = None,
        content_filter_options: None = None,
    ) -> Reader:
        """Call `callback` with each message, in the node's order. `qos`, `on_event`: as those of a
        publisher. Raises AddressError, UnknownType; LocalProtocolError for a filter, which there is
        none of."""
        self._check()
        if content_filter_options is not None:
            raise LocalProtocolError(
                f"{topic}: messages are not filtered by their content here: subscribe without "
                "content_filter_options, and let the callback return where a message is not wanted"
            )
        worker = self._keep(Worker(f"yarpy topic {topic}"))
        whole = self.resolve(topic)
        made = self._used(self._rmw.reader(whole, type_, callback, worker, _qos(qos)))
        made.events.hear = on_event
        return made

    # -- services ---------------------------------------------------------------------------------

    def service(
        self, name: str, type_: str, handler: Callable[[Any], object], *, threads: int = 1
    ) -> Answerer:
        """Serve a service: `handler(request)` returns the response, an object or a list or dict of
        its fields. What it raises is told to the client. Questions are answered one after the
        other; with more `threads`, as many side by side. Raises AddressError, UnknownType,
        ValueError."""

        def answer(question: Question) -> None:
            found = handler(question.request)
            question.answer(made.kind.Response() if found is None else found)

        worker = self._keep(Worker(f"yarpy service {name}", threads))
        whole = self.resolve(name, "rosservice")
        made = self._answer(whole, type_, answer, worker, None)
        return made

    def client(self, name: str, type_: str) -> Caller:
        """Return what asks a service: `client.call(request)`, `client.ask(request)`. Raises
        AddressError, UnknownType."""
        return self._caller(self.resolve(name, "rosservice"), type_)

    def call(self, name: str, type_: str, *arguments: Any, timeout: float | None = 10.0) -> Any:
        """Ask a service; the answer is an object of the response type. `arguments` are an object
        of the request type, a dict of some of its fields, a list of all, or the fields. Raises
        UnknownName (nobody serves it), RemoteProtocolError (the server fails), Timeout,
        LinkClosed."""
        whole = self.resolve(name, "rosservice")
        found = self._callers.get((whole, type_))
        if found is None:
            found = self._callers.setdefault((whole, type_), self._caller(whole, type_))
        return found.call(found.kind.request(*arguments), timeout)

    # -- parameters -------------------------------------------------------------------------------

    def parameters_of(self, node: str, timeout: float | None = 5.0) -> RemoteParameters:
        """Return the parameters of another node, to be asked for and changed."""
        return self._keep(RemoteParameters(expand(node, self._node), self._caller, timeout))

    # -- actions ----------------------------------------------------------------------------------

    def action_server(
        self,
        name: str,
        type_: str,
        execute: Callable[[Goal], object],
        *,
        accept: Callable[[Any], bool] = lambda request: True,
        cancel: Callable[[Goal], bool] = lambda goal: True,
    ) -> ActionServer:
        """Take goals of an action: `execute(goal)` runs in a thread of its own, and returns the
        result. `accept(request)`: whether one is taken; `cancel(goal)`: whether it may be canceled.
        Raises AddressError, UnknownType."""
        action = default_library().action(type_)
        whole = self.resolve(name)
        server = ActionServer(whole, action, execute, accept, cancel)
        told = self.publisher(place(whole, "feedback"), f"{action.name}_FeedbackMessage")
        status = self.publisher(place(whole, "status"), STATUS_TYPE, qos=STATUS_QOS)
        server.publish_feedback, server.publish_status = told.write, status.write
        self._keep(server)
        types = {"send_goal": f"{action.name}_SendGoal", "get_result": f"{action.name}_GetResult"}
        for what, handler in server.handlers.items():
            self._answer(
                place(whole, what), types.get(what, CANCEL_TYPE), handler, self._worker, None
            )
        return server

    def action_client(self, name: str, type_: str) -> ActionClient:
        """Return what sends goals: `client.send(goal).result(timeout=5)`. Raises AddressError,
        UnknownType."""
        action = default_library().action(type_)
        whole = self.resolve(name)
        worker = self._keep(Worker(f"yarpy action {name}"))
        client = ActionClient(
            whole,
            action,
            self._caller(place(whole, "send_goal"), f"{action.name}_SendGoal"),
            self._caller(place(whole, "get_result"), f"{action.name}_GetResult"),
            self._caller(place(whole, "cancel_goal"), CANCEL_TYPE),
            worker,
        )
        heard = {
            "feedback": (f"{action.name}_FeedbackMessage", client.hear_feedback, Qos()),
            "status": (STATUS_TYPE, client.hear_status, STATUS_QOS),
        }
        for what, (kind, callback, qos) in heard.items():
            topic = place(whole, what)
            self._used(self._rmw.reader(topic, kind, callback, worker, qos))
        return client

    # -- the end ----------------------------------------------------------------------------------

    def close(self) -> None:
        """Take everything of the node back; goals under way are canceled. Idempotent."""
        if self._closed:
            return
        self._closed = True
        self.logger.handlers.clear()
        for item in reversed(self._held):
            item.close()
        self._held.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Node {self.name}>"

    def _tell(self, change: Change) -> None:
        if not self._closed:
            try:
                self._events.write(event(self.name, change))
            except DecodeError as error:
                log.warning("%s: a change of parameters is not told: %s", self.name, error)

    def _answer(
        self,
        name: str,
        type_: str,
        handler: Callable[[Question], None],
        worker: Worker,
        qos: Qos | None,
    ) -> Answerer:
        self._check()
        return self._used(self._rmw.answerer(name, type_, handler, worker, qos))

    def _caller(self, name: str, type_: str) -> Caller:
        self._check()
        return self._used(self._rmw.caller(name, type_, None))

    def _watch(self, changes: dict[str, Any]) -> None:
        if SIMULATED in changes:
            self._time.follow(changes[SIMULATED] is True)

    def _hear_clock(self, heard: Callable[[Any], object]) -> Reader:
        return self.subscriber(CLOCK, "rosgraph_msgs/msg/Clock", heard, qos=CLOCK_QOS)

    def _check(self) -> None:
        if self._closed:
            raise LocalProtocolError(f"{self.name} is closed")

    def _used(self, made: C) -> C:
        """Keep an endpoint, and tell others of its type."""
        self._describer.know(made.kind)  # type: ignore[attr-defined]
        return self._keep(made)

    def _keep(self, item: C) -> C:
        self._held.append(item)
        return item


def is_said(said: str | None, environment: Mapping[str, str] = os.environ) -> bool:
    """Return whether somebody says which it is, DDS or Zenoh."""
    return bool(said or environment.get(MIDDLEWARE))


def is_dds(said: str | None = None, environment: Mapping[str, str] = os.environ) -> bool:
    """Return whether a node speaks DDS, not Zenoh: what is said, else what RMW_IMPLEMENTATION
    names, else Zenoh. Raises AddressError."""
    name = said or environment.get(MIDDLEWARE) or "zenoh"
    if name in ("zenoh", "rmw_zenoh_cpp"):
        return False
    if name == "dds" or (said is None and name.startswith("rmw_")):
        return True
    raise AddressError(f'"{name[:80]}" carries no messages of ROS 2: it is zenoh or dds')


def chosen(said: str | None, environment: Mapping[str, str] = os.environ) -> Callable[..., Rmw]:
    """Return what makes the layer for a node, by `is_dds`. Raises AddressError."""
    if is_dds(said, environment):
        from yarpy.peers.ros2.dds.rmw import DdsRmw

        return DdsRmw
    from yarpy.peers.ros2.zenoh.rmw import ZenohRmw

    return ZenohRmw


def _qos(said: str | Qos | None) -> Qos | None:
    return profile(said) if isinstance(said, str) else said
