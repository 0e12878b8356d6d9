"""What can be imported: the names of the original, read from its files, and its programs."""

from __future__ import annotations

import ast
import importlib
import json
import os
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import wait_until
from support.wrapyfi_venv import prepare

import yarpy

zmq = pytest.importorskip("zmq", reason="needs pyzmq (pip install pyzmq)")

SOURCE = Path(__file__).parents[2] / "compat" / "wrapyfi" / "src"

#: names that are not here: parts of how the original starts brokers, and finds its version
PARTS = {
    "ZEROMQ_POST_OPTS",
    "ZeroMQMiddlewarePubSubListen",
    "ZeroMQMiddlewarePubSubPublish",
    "ROSNativeObjectService",
    "ROSImageService",
    "get_project_info_from_setup",
    "project_info",
    "mdata",
    "name",
    "lock",
}
#: methods that take or give things of libraries that are not here, such as messages of paho
INNER = {
    "find_plugin",
    "get_message_type",
    "get_topic_type",
    "is_connected",
    "on_message",
    "proxy_thread",
    "publish_params",
    "read_port",
    "read_socket",
    "register_callback",
    "subscription_monitor_thread",
}


SIDES = ("publishers", "listeners", "servers", "clients")


@pytest.fixture(scope="module")
@brings("wrapyfi")
def original() -> Path:
    (found,) = (prepare() / "lib").glob("python3*/site-packages/wrapyfi")
    return found


def is_setting(module: str, name: str) -> bool:
    """Return whether it is a constant of the environment, which here is read when it is needed."""
    return name.isupper() and module.partition(".")[0] in SIDES


def names_of(path: Path) -> Iterator[str]:
    """What a module defines for others."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it has escapes that Python does not know
        bodies = [ast.parse(path.read_text("utf-8")).body]
    for body in bodies:
        for item in body:
            if isinstance(item, ast.ClassDef | ast.FunctionDef):
                yield item.name
            elif isinstance(item, ast.Assign):
                yield from (each.id for each in item.targets if isinstance(each, ast.Name))
            elif isinstance(item, ast.Try):
                bodies.append(item.body)


def test_names_of_the_original(original: Path) -> None:
    missing = set()
    for path in sorted(original.rglob("*.py")):
        parts = path.relative_to(original).with_suffix("").parts
        module = ".".join(part for part in parts if part != "__init__")
        if module.startswith("tests"):
            continue
        found = importlib.import_module(f"wrapyfi.{module}".rstrip("."))
        for name in names_of(path):
            if name in PARTS or name.startswith("__") or is_setting(module, name):
                continue
            if not hasattr(found, name):
                missing.add(f"{module}.{name}")
    programs = "zeromq_proxy_broker", "zeromq_pubsub_topic_monitor", "zeromq_param_server"
    assert missing <= {f"standalone.{name}.args" for name in programs}  # there when they run


def methods_of(path: Path) -> Iterator[tuple[str, str]]:
    """The classes of a module, with the methods that others may call."""
    for item in ast.parse(path.read_text("utf-8")).body:
        if isinstance(item, ast.ClassDef):
            for part in item.body:
                if isinstance(part, ast.FunctionDef) and not part.name.startswith("_"):
                    yield item.name, part.name


def test_methods_of_the_original(original: Path) -> None:
    missing = set()
    for path in sorted(original.rglob("*.py")):
        parts = path.relative_to(original).with_suffix("").parts
        if parts[0] in ("tests", "plugins"):
            continue
        module = ".".join(part for part in parts if part != "__init__")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # as above
            found = importlib.import_module(f"wrapyfi.{module}".rstrip("."))
            for name, method in methods_of(path):
                if name not in PARTS and not hasattr(getattr(found, name), method):
                    missing.add(method)
    assert missing == INNER


@pytest.mark.parametrize("side", SIDES)
def test_classes_by_their_names(side: str) -> None:
    """They are those that the decorators take, and derive from that of their middleware."""
    word = side.title().removesuffix("s")
    module = importlib.import_module(f"wrapyfi.{side}.yarp")
    registry = getattr(module, f"{word}s").registry
    for kind in ("NativeObject", "Image", "AudioChunk"):
        found = getattr(module, f"Yarp{kind}{word}")
        assert found is registry[f"{kind}:yarp"]
        assert issubclass(found, getattr(module, f"Yarp{word}"))
        assert issubclass(found, getattr(module, word))
    package = importlib.import_module(f"wrapyfi.{side}")
    assert issubclass(getattr(package, f"Fallback{word}"), getattr(package, word))


def test_a_publisher_and_a_listener_by_hand() -> None:
    """As a program does that takes the classes without the decorators."""
    from wrapyfi.listeners.yarp import YarpNativeObjectListener  # type: ignore[import-not-found]
    from wrapyfi.publishers.yarp import YarpNativeObjectPublisher  # type: ignore[import-not-found]

    with yarpy.NameServer(free_block(10)) as server, pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARPY_SERVER", f"127.0.0.1:{server.port}")
        publisher = YarpNativeObjectPublisher("sender", "/by/hand", should_wait=False)
        listener = YarpNativeObjectListener("hearer", "/by/hand", should_wait=False)
        try:
            assert publisher.establish()
            wait_until(listener.establish, what="the listener is connected")
            found = []

            def came() -> bool:
                publisher.publish({"a": (1, 2)})
                found.append(listener.listen())
                return found[-1] is not None

            wait_until(came, what="a value has come")
            assert found[-1] == {"a": (1, 2)}
        finally:
            listener.close()
            publisher.close()


def test_connections_are_waited_for_as_long_as_is_said() -> None:
    from wrapyfi.connect.publishers import PublisherWatchDog  # type: ignore[import-not-found]
    from wrapyfi.listeners.yarp import YarpNativeObjectListener
    from wrapyfi.publishers.yarp import YarpNativeObjectPublisher

    with yarpy.NameServer(free_block(10)) as server, pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARPY_SERVER", f"127.0.0.1:{server.port}")
        publisher = YarpNativeObjectPublisher("sender", "/awaited")
        listener = YarpNativeObjectListener("hearer", "/awaited")
        early = YarpNativeObjectListener("early", "/never")
        hasty = YarpNativeObjectPublisher("hasty", "/hasty", should_wait=False)
        try:
            assert not early.establish(repeats=1)
            assert not early.established
            assert not hasty.await_connection()
            assert hasty.establish()
            watch = PublisherWatchDog()
            watch.add_publisher(publisher)
            watch.scan()
            assert watch.publisher_ring == [publisher]  # nobody listens
            assert not publisher.await_connection(repeats=1)
            assert listener.establish()
            assert listener.await_connection("/awaited")
            assert publisher.await_connection()
            watch.scan()
            assert not watch.publisher_ring
            publisher.publish("hello")
            assert listener.listen() == "hello"
        finally:
            for side in (listener, publisher, early, hasty):
                side.close()


def test_helpers() -> None:
    from wrapyfi.connect.wrapper import (  # type: ignore[import-not-found]
        deepcopy,
        get_default_args,
        match_args,
    )

    assert match_args(("$0", 3), {"a": "$b", "c": "d"}, ["x"], {"b": 2}) == (
        ("x", 3),
        {"a": 2, "c": "d"},
    )
    assert get_default_args(lambda a, b=3: None) == {"b": 3}
    inner = [1]
    found = deepcopy({"a": inner, "b": inner, "c": [{"b": 1, "d": 2}]}, ["b"], ["a"])
    assert found == {"a": [1], "c": [{"d": 2}]} and found["a"] is inner
    assert deepcopy(inner) == inner and deepcopy(inner) is not inner


def test_a_middleware_may_be_imported_first() -> None:
    """In a program of its own, and the others are there for all that."""
    asked = "import wrapyfi.middlewares.zeromq; from wrapyfi.connect._registry import missing; "
    asked += "print('missing', [why for why in missing.values() if 'circular' in why])"
    path = os.pathsep.join(map(str, (SOURCE, SOURCE.parents[2] / "src")))
    environment = {**os.environ, "PYTHONPATH": path}
    with Process([sys.executable, "-c", asked], env=environment) as program:
        assert program.wait_line("^missing (.*)$", stream="out")[1] == "[]"


def command(module: str, *words: str) -> Process:
    path = os.pathsep.join(map(str, (SOURCE, SOURCE.parents[2] / "src")))
    environment = {**os.environ, "PYTHONPATH": path, "PYTHONUNBUFFERED": "1"}
    return Process([sys.executable, "-m", f"wrapyfi.standalone.{module}", *words], env=environment)


def test_the_broker_and_who_watches_it() -> None:
    number = free_block(2)
    words = ("--socket_pub_port", str(number), "--socket_sub_port", str(number + 1))
    context = zmq.Context()
    watched = ("--socket_pub_address", f"tcp://127.0.0.1:{number}")
    try:
        with (
            command("zeromq_proxy_broker", *words) as broker,
            command("zeromq_pubsub_topic_monitor", *watched) as monitor,
        ):
            wait_until(lambda: "broker of topics" in broker.stdout + broker.stderr)
            reader, writer = context.socket(zmq.SUB), context.socket(zmq.PUB)
            reader.connect(f"tcp://127.0.0.1:{number}")
            reader.subscribe("robot")
            writer.connect(f"tcp://127.0.0.1:{number + 1}")

            def came() -> bool:
                writer.send_multipart([b"robot", json.dumps([1]).encode()])
                return bool(reader.poll(100))

            wait_until(came)
            assert reader.recv_multipart() == [b"robot", b"[1]"]
            # It hears of what comes after it: whoever looks late sees the next change.
            reader.subscribe("more")
            wait_until(lambda: "ZEROMQ/CONNECTIONS" in monitor.stdout + monitor.stderr)
    finally:
        context.destroy(linger=0)
