"""Every public call that may block has a time limit, and keeps it, whoever is silent; and whoever
closes or interrupts a port wakes the calls that are blocked in it.

Rules: the methods are found by looking at the classes, so none that is new is left out: it belongs
into CALLS, with what it is called, or into AT_ONCE, if it never waits for anybody. Those who are
silent: a listener that accepts and says nothing, a name server that does (as one that was stopped),
and an address that swallows what is sent there, as a computer that is switched off. A timer of the
program interrupts the main thread meanwhile, which makes no wait longer.
"""

from __future__ import annotations

import inspect
import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from typing import Any, Self

import pytest
from support.timer import beating
from support.wait import HANG

import yarpy
from yarpy.names.default import DEFAULT
from yarpy.port.options import PortOptions

LIMIT = 0.2  # seconds that calls are given here
# They are back within 50 ms of that, and of being ended, where the machine has time for them. Here
# others are at work, too: what would be wrong is late by seconds.
SLACK = 1.0
PULSE = 0.005  # seconds between looks whether this process still runs

Call = Callable[..., object]

# What is asked of a port: `p` is the port, `to` who is silent.
CALLS: dict[str, dict[str, Call]] = {
    "BasePort": {
        "connect": lambda p, to, timeout: p.connect(to, timeout=timeout),
        "disconnect": lambda p, to, timeout: p.disconnect(to, timeout=timeout),
        "listen_to": lambda p, to, timeout: p.listen_to(to, timeout=timeout),
        "wait_for_inputs": lambda p, to, timeout: p.wait_for_inputs(timeout=timeout),
        "wait_for_outputs": lambda p, to, timeout: p.wait_for_outputs(timeout=timeout),
        "close": lambda p, to, timeout: p.close(timeout=timeout),
    },
    "MessagePort": {
        "read": lambda p, to, timeout: p.read(timeout=timeout),
        "flush": lambda p, to, timeout: p.flush(timeout=timeout),
        "write": lambda p, to, timeout: p.write(1, timeout=timeout),
    },
    "Port": {"ask": lambda p, to, timeout: p.ask(1, timeout=timeout)},
    "BufferedPort": {},
    "RpcServer": {},
    "RpcClient": {
        "connect": lambda p, to, timeout: p.connect(to, timeout=timeout),
        "call": lambda p, to, timeout: p.call(1, timeout=timeout),
        "ask": lambda p, to, timeout: p.ask(1, timeout=timeout),
        "tell": lambda p, to, timeout: p.tell(1, timeout=timeout),
    },
}
# These never wait for anybody else.
AT_ONCE = {
    *("attach", "detach", "interrupt", "resume", "poll", "prepare", "read_strictly"),
    *("on_connection", "on_deadline", "on_admin", "on_page"),
}
FUNCTIONS: dict[str, Call] = {
    "admin": lambda to, timeout: yarpy.admin(to, "ver", timeout=timeout),
    "connect": lambda to, timeout: yarpy.connect(to, to, timeout=timeout),
    "disconnect": lambda to, timeout: yarpy.disconnect(to, to, timeout=timeout),
    "exists": lambda to, timeout: yarpy.exists(to, timeout=timeout),
    "is_connected": lambda to, timeout: yarpy.is_connected(to, to, timeout=timeout),
    "ping": lambda to, timeout: yarpy.ping(to, timeout=timeout),
    "query": lambda to, timeout: yarpy.query(to, timeout=timeout),
    "wait_for": lambda to, timeout: yarpy.wait_for(to, timeout=timeout),
}
OPENING: dict[str, Call] = {
    "Port": lambda timeout: yarpy.Port("/new", timeout=timeout),
    "BufferedPort": lambda timeout: yarpy.BufferedPort("/new", timeout=timeout),
    "RpcServer": lambda timeout: yarpy.RpcServer("/new", print, timeout=timeout),
    "RpcClient": lambda timeout: yarpy.RpcClient(name="/new", timeout=timeout),
}
FUNCTIONS_AT_ONCE = {"from_json", "realtime", "to_json"}


@pytest.fixture(autouse=True)
def timer() -> Iterator[None]:
    with beating():
        yield


@pytest.fixture
def silent() -> Iterator[int]:
    """The number of a listener that accepts, as its system does, and never says a word."""
    with socket.create_server(("127.0.0.1", 0), backlog=64) as listener:
        yield listener.getsockname()[1]


@pytest.fixture(scope="module")
def hole() -> Iterator[int]:
    """The number of a listener at which connections neither succeed nor fail: its queue is full."""
    with ExitStack() as open_:
        listener = open_.enter_context(socket.create_server(("127.0.0.1", 0), backlog=0))
        number = listener.getsockname()[1]
        while True:
            sock = open_.enter_context(socket.socket())
            sock.settimeout(0.2)
            try:
                sock.connect(("127.0.0.1", number))
            except TimeoutError:
                break
        yield number


@pytest.fixture(params=["listener", "name server", "hole"])
def nobody(
    request: pytest.FixtureRequest, silent: int, monkeypatch: pytest.MonkeyPatch
) -> Iterator[str]:
    """The name of a port that is silent, for one of the three reasons."""
    if request.param == "name server":
        monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{silent}")
        yield "/silent"
        return
    names = yarpy.LocalNames()
    number = silent if request.param == "listener" else request.getfixturevalue("hole")
    names.register("/silent", "tcp", "127.0.0.1", number)
    names.set("/silent", "process", 1)  # as of a port that has registered itself
    DEFAULT.push(names)
    try:
        yield "/silent"
    finally:
        DEFAULT.pop(names)


class Stalls:
    """How long the machine let a thread of this process wait that wanted to run, of all the time in
    which this is entered: other programs had the processor."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch)

    def _watch(self) -> None:
        while not self._over.is_set():
            begun = time.monotonic()
            self._over.wait(PULSE)
            self.seconds += max(0.0, time.monotonic() - begun - PULSE)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()


def in_time(act: Callable[[], object], limit: float = LIMIT) -> float:
    begun = time.monotonic()
    with Stalls() as stalls:
        with suppress(yarpy.YarpError):
            act()
        taken = time.monotonic() - begun
    assert taken <= limit + SLACK + stalls.seconds
    return taken


def public(kind: type) -> set[str]:
    return {
        name
        for name, value in vars(kind).items()
        if not name.startswith("_") and inspect.isfunction(value)
    }


def kinds() -> dict[str, type]:
    found = {}
    for top in (yarpy.Port, yarpy.BufferedPort, yarpy.RpcServer, yarpy.RpcClient):
        for kind in top.__mro__[:-1]:
            if kind.__module__.startswith("yarpy"):
                found[kind.__name__] = kind
    return found


def open_(kind: str, nobody: str) -> Any:
    """A port of a kind; not registered, so that its end is not that of a name server."""
    if kind == "RpcClient":
        return yarpy.RpcClient()
    return yarpy.BufferedPort("") if kind == "BufferedPort" else yarpy.Port("")


def test_every_public_method_is_in_the_tables():
    for name, kind in kinds().items():
        assert public(kind) - AT_ONCE == CALLS[name].keys(), f"methods of {name}"
    functions = {
        name
        for name in yarpy.__all__
        if inspect.isfunction(getattr(yarpy, name)) and not inspect.isclass(getattr(yarpy, name))
    }
    assert functions - FUNCTIONS_AT_ONCE == FUNCTIONS.keys()
    ports = {name for name in yarpy.__all__ if isinstance(getattr(yarpy, name), type)}
    assert {name for name in ports if issubclass(getattr(yarpy, name), kinds()["BasePort"])} == (
        OPENING.keys()
    )


def test_every_one_of_them_has_a_time_limit():
    for name, calls in CALLS.items():
        for method in calls:
            parameter = inspect.signature(getattr(kinds()[name], method)).parameters["timeout"]
            assert parameter.default is None, f"{name}.{method}"
    for name in FUNCTIONS:
        assert "timeout" in inspect.signature(getattr(yarpy, name)).parameters, name
    for name in OPENING:
        options = inspect.signature(getattr(yarpy, name)).parameters["options"]
        assert (
            options.annotation == "Unpack[PortOptions]" and "timeout" in PortOptions.__annotations__
        ), name


METHODS = [(kind, method) for kind, calls in CALLS.items() for method in calls]


@pytest.mark.parametrize(("kind", "method"), METHODS)
def test_a_method_keeps_its_time_limit(kind: str, method: str, nobody: str):
    with open_(kind, nobody) as port:
        in_time(lambda: CALLS[kind][method](port, nobody, LIMIT))


@pytest.mark.parametrize(("kind", "method"), [one for one in METHODS if one[1] != "close"])
@pytest.mark.parametrize("end", ["interrupt", "close"])
def test_whoever_ends_a_port_wakes_its_calls(kind: str, method: str, end: str, nobody: str):
    begun = threading.Event()

    def called(port: Any) -> BaseException | None:
        begun.set()
        try:
            CALLS[kind][method](port, nobody, 10.0)
        except yarpy.YarpError as error:
            return error
        return None

    with open_(kind, nobody) as port:
        over: list[tuple[BaseException | None, float]] = []
        thread = threading.Thread(target=lambda: over.append((called(port), time.monotonic())))
        thread.start()
        assert begun.wait(HANG)
        thread.join(0.2)
        blocked = thread.is_alive()
        ended = time.monotonic()
        with Stalls() as stalls:
            getattr(port, end)()
            thread.join(HANG)
        error, back = over[0]
        if blocked:
            assert back - ended <= SLACK + stalls.seconds
    if blocked and not isinstance(error, yarpy.PortClosed):
        with open_(kind, nobody) as port:  # a busy machine: it waits for nothing
            assert type(called(port)) is type(error)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_keeps_its_time_limit(name: str, nobody: str):
    in_time(lambda: FUNCTIONS[name](nobody, LIMIT))


@pytest.mark.parametrize("name", OPENING)
def test_opening_keeps_its_time_limit(name: str, silent: int, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{silent}")
    assert in_time(lambda: OPENING[name](LIMIT)) > LIMIT / 2


@pytest.mark.parametrize("what", ["one connection out", "one connection in", "a name"])
def test_closing_does_not_wait_for_who_was_stopped(what: str, monkeypatch: pytest.MonkeyPatch):
    names = yarpy.LocalNames()
    with ExitStack() as open_ports:
        port = yarpy.Port("/closing", names=names)
        if what == "a name":
            monkeypatch.setattr(names, "unregister", lambda name: time.sleep(0.1))
        else:
            peer = open_ports.enter_context(yarpy.Port("/peer", names=names))
            one, other = (port, peer) if what == "one connection out" else (peer, port)
            one.connect(other.name)
        in_time(lambda: port.close(timeout=LIMIT))


ARGUMENTS = {
    "admin": ("/silent", "ver"),
    "connect": ("/silent", "/silent"),
    "disconnect": ("/silent", "/silent"),
    "is_connected": ("/silent", "/silent"),
}


def test_without_a_time_limit_a_person_can_wait_for_them(nobody: str):
    """All at the same time, but wait_for, which waits for as long as it takes."""

    def call(name: str) -> None:
        in_time(lambda: getattr(yarpy, name)(*ARGUMENTS.get(name, ("/silent",))), 5.0)

    names = FUNCTIONS.keys() - {"wait_for"}
    with ThreadPoolExecutor(len(names)) as threads:
        for name, done in {name: threads.submit(call, name) for name in names}.items():
            assert done.exception() is None, name
