"""What nodes need whatever carries their messages."""

from __future__ import annotations

import logging
import sys
import threading
from concurrent.futures import Future
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.errors import Timeout
from yarpy.limit import ROS2_QUESTIONS
from yarpy.peers.ros2.carrier import Incoming, Outgoing
from yarpy.peers.ros2.exchange import Question, Worker, answer_with, result_of
from yarpy.peers.ros2.message.library import default_library


class Server:
    name = "/add"
    kind: Any = default_library().service("example_interfaces/AddTwoInts")

    def __init__(self) -> None:
        self.dropped = 0
        self.given: list[Outgoing] = []

    def give(self, item: Outgoing) -> None:
        self.given.append(item)

    def ended(self) -> bool:
        return False


def test_a_worker_takes_one_after_the_other(caplog: pytest.LogCaptureFixture) -> None:
    worker, free, done = Worker("test"), threading.Event(), []

    def act(item: Any) -> None:
        free.wait()
        if item == 0:
            raise ValueError("of the test")
        done.append(item)

    with caplog.at_level(logging.ERROR):
        sent = [worker.put(act, number) for number in range(ROS2_QUESTIONS + 2)]
        assert sent[0] and not sent[-1]
        free.set()
        wait_until(lambda: len(done) >= ROS2_QUESTIONS - 1)
    assert done == sorted(done)
    assert "a callback failed" in caplog.text
    worker.close()
    worker.threads[0].join()
    assert not worker.put(act, 1)


def test_who_calls_sys_exit_ends_no_worker(caplog: pytest.LogCaptureFixture) -> None:
    worker, done = Worker("test"), threading.Event()
    worker.put(sys.exit, 3)
    worker.put(lambda _: done.set(), 0)
    assert done.wait(HANG)
    assert "sys.exit() in a thread of a port ends no program" in caplog.text
    worker.close()


def test_a_worker_of_several_threads_takes_as_many_at_once() -> None:
    worker, both = Worker("test", threads=2), threading.Barrier(3)
    for item in range(2):
        assert worker.put(lambda _: both.wait(HANG), item)
    both.wait(HANG)  # neither gets here alone
    worker.close()
    for thread in worker.threads:
        thread.join()
    with pytest.raises(ValueError, match="0 threads answer nothing"):
        Worker("test", threads=0)


def test_questions_are_answered_once() -> None:
    server = Server()
    body = b"".join(server.kind.Request(a=1, b=2).to_ros())

    def add(question: Question) -> None:
        question.answer([question.request.a + question.request.b])
        question.answer([0])

    answer_with(server, add, Incoming(body, asked="who"), "/node")
    (given,) = server.given
    assert (given.to, server.kind.Response.from_ros(b"".join(given.body)).sum) == ("who", 3)


def answer_in_a_thread(server: Server, handler: Any, item: Incoming) -> None:
    """As in a node: in the main thread of a program sys.exit() goes on."""
    thread = threading.Thread(target=answer_with, args=(server, handler, item, "/node"))
    thread.start()
    thread.join(HANG)


def test_what_is_no_question_is_told() -> None:
    server = Server()
    answer_with(server, lambda question: None, Incoming(b"\0\1\0\0", asked="who"), "/node")
    assert server.dropped == 1 and server.given[0].failure

    def fail(question: Question) -> None:
        raise ZeroDivisionError("of the test")

    body = b"".join(server.kind.Request(a=1, b=2).to_ros())
    answer_with(server, fail, Incoming(body, asked="who"), "/node")
    assert server.given[1].failure == "ZeroDivisionError: of the test"

    def leave(question: Question) -> None:
        sys.exit(3)

    answer_in_a_thread(server, leave, Incoming(body, asked="who"))
    assert server.given[2].failure == "SystemExit: 3"


def test_results_in_time() -> None:
    future: Future[int] = Future()
    with pytest.raises(Timeout, match="/add did not answer within"):
        result_of(future, 0.0, "/add")
    future.set_result(3)
    assert result_of(future, 0.0, "/add") == 3
