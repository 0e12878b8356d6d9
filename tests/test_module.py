"""Module: its life, what it answers, how it ends - asked, by a signal, by itself, by an error."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, LocalNames, ResourceFinder, RpcClient
from yarpy.module import Module


class Counter(Module):
    """Counts its updates, and writes down what happens to it."""

    name = "/counter"
    period = 0.01
    commands = {"count": "tell how often update was called"}

    def __init__(self) -> None:
        self.count = 0
        self.said: list[str] = []

    def configure(self, resources: ResourceFinder) -> bool | None:
        self.said.append("configure")
        self.limit = resources.find("limit", 0)
        return not resources.check("refuse")

    def update(self) -> bool | None:
        self.count += 1
        return self.count != self.limit

    def respond(self, request: Bottle) -> object:
        match request:
            case ["count"]:
                return [self.count]
        return None

    def interrupt(self) -> None:
        self.said.append("interrupt")

    def close(self) -> None:
        self.said.append("close")


@contextmanager
def running(module: Module, names: LocalNames, *arguments: str) -> Iterator[list[int]]:
    codes: list[int] = []

    def run() -> None:
        codes.append(module.run(ResourceFinder(arguments), names=names))

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield codes
    finally:
        module.stop()
        thread.join(HANG)
    assert not thread.is_alive()


def test_life_ends_when_update_says_so() -> None:
    module = Counter()
    assert module.run(ResourceFinder(["--limit", "3"]), names=LocalNames()) == 0
    assert module.count == 3
    assert module.said == ["configure", "close"]


@pytest.mark.parametrize("options", [[], ["--period", "1"], "robot.ini"])
def test_options_as_they_are_typed_are_refused(options: Any) -> None:
    with pytest.raises(TypeError, match=r"run\(yarpy\.ResourceFinder\(sys\.argv\[1:\]\)\)"):
        Module().run(options)


def test_configuration_that_fails_ends_it_before_it_begins(
    caplog: pytest.LogCaptureFixture,
) -> None:
    module = Counter()
    assert module.run(ResourceFinder(["--refuse"]), names=LocalNames()) == 1
    assert module.said == ["configure"]
    module.name = ""
    assert module.run(ResourceFinder(["--refuse"]), names=LocalNames()) == 1
    told = [line.partition(" gives up")[0] for line in caplog.messages]
    assert told == ["/counter", "Counter"]


@pytest.mark.parametrize("word", ["quit", "exit", "bye"])
def test_questions(word: str) -> None:
    names, module = LocalNames(), Counter()
    with running(module, names, "--name", "/mine") as codes:
        wait_until(lambda: names.query("/mine/quit") is not None)
        with RpcClient("/mine/rpc", names=names) as client:
            assert client.call("count") == [module.count] or module.count > 0
            assert client.call("help") == [
                "many",
                "count: tell how often update was called",
                "help: tell the commands",
                "quit: end the module",
            ]
            assert client.call("dance", 3) == ["fail", "unknown command dance 3: try help"]
            assert client.call(word) == ["bye"]
        wait_until(lambda: codes)
    assert module.said[:2] == ["configure", "interrupt"]
    assert "close" in module.said


def test_port_quit() -> None:
    names, module = LocalNames(), Counter()
    with running(module, names) as codes:
        wait_until(lambda: names.query("/counter/quit") is not None)
        with RpcClient("/counter/quit", names=names) as client:
            assert client.call("sing") == ["fail", "say quit"]
            assert client.call("quit") == ["ok"]
        wait_until(lambda: codes)


def test_interrupt_wakes_a_reader() -> None:
    class Reader(Module):
        def configure(self, resources: ResourceFinder) -> None:
            self.port = yarpy.Port("/reader", names=names)

        def update(self) -> None:
            self.port.read()

        def interrupt(self) -> None:
            self.port.interrupt()

        def close(self) -> None:
            self.port.close()

    names, module = LocalNames(), Reader()
    with running(module, names) as codes:
        wait_until(lambda: names.query("/reader") is not None)
        module.stop()
        wait_until(lambda: codes)
    assert codes == [0]


def test_error_closes_and_is_passed_on() -> None:
    class Failing(Counter):
        def update(self) -> bool | None:
            raise yarpy.LinkClosed("gone")

    module = Failing()
    with pytest.raises(yarpy.LinkClosed):
        module.run(names=LocalNames())
    assert module.said == ["configure", "close"]


PROGRAM = """
import sys, time, yarpy
def say(text):
    sys.stdout.write(text + "\\n")
    sys.stdout.flush()
class Slow(yarpy.Module):
    def update(self):
        say("up")
        if self.stubborn:
            while True:
                time.sleep(0.01)
    def configure(self, resources):
        self.stubborn = resources.check("stubborn")
    def interrupt(self):
        say("interrupt")
    def close(self):
        say("closed")
sys.exit(Slow().run(yarpy.ResourceFinder(sys.argv[1:])))
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_it_in_good_order(number: signal.Signals) -> None:
    with Process([sys.executable, "-c", PROGRAM]) as process:
        process.wait_line("up")
        process.signal(number)
        assert process.wait(HANG) == 0, process.stderr
        assert process.stdout.splitlines()[-2:] == ["interrupt", "closed"]


def test_fourth_signal_ends_it_at_once() -> None:
    with Process([sys.executable, "-c", PROGRAM, "--stubborn"]) as process:
        process.wait_line("up")
        for count in range(1, 4):
            process.signal(signal.SIGINT)
            process.wait_line("interrupt", count=count)
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 128 + signal.SIGINT
