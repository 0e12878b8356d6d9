"""Services of a program: answered now, later, or not at all."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.exchange import Question, Worker
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.zenoh.service import Answerer, Caller

ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture
def asked() -> list[Question]:
    return []


@pytest.fixture
def server(names: yarpy.LocalNames, asked: list[Question]) -> Iterator[Answerer]:
    worker = Worker("test")
    found = Answerer(Node("/", "s"), 0, "/later", ADD, asked.append, worker)
    yield found
    found.close()
    worker.close()


@pytest.fixture
def caller(server: Answerer) -> Iterator[Caller]:
    found = Caller(Node("/", "c"), 0, "/later", ADD)
    assert found.wait(HANG)
    yield found
    found.close()


def test_answers_in_any_order(caller: Caller, asked: list[Question]) -> None:
    futures = [caller.ask([n, 0]) for n in range(3)]
    wait_until(lambda: len(asked) == 3)
    for question in reversed(asked):
        question.answer([question.request.a * 10])
        question.answer([99])  # once
    assert [future.result(HANG).sum for future in futures] == [0, 10, 20]


def test_failures(caller: Caller, asked: list[Question]) -> None:
    future = caller.ask({"a": 1})
    wait_until(lambda: asked)
    asked[0].fail("I would rather not")
    with pytest.raises(yarpy.errors.RemoteProtocolError, match="rather not"):
        future.result(HANG)
    with pytest.raises(yarpy.Timeout, match="did not answer within"):
        caller.call([1, 2], timeout=0.01)
    with pytest.raises((TypeError, ValueError)):
        caller.ask(["x", 2])


def test_a_handler_that_raises(names: yarpy.LocalNames) -> None:
    def handler(request: Any) -> object:
        return {5: 1 // 0} if request.a else None

    with ros2.Node("/s") as server, ros2.Node("/c") as asker:
        server.service("/bad", ADD, handler)
        client = asker.client("/bad", ADD)
        assert client.wait(HANG)
        assert client.call([0, 0]).sum == 0
        with pytest.raises(yarpy.errors.RemoteProtocolError, match="ZeroDivisionError"):
            client.call([1, 0])


def test_slow_questions_are_answered_side_by_side(names: yarpy.LocalNames) -> None:
    both = threading.Barrier(2)

    def meet(request: Any) -> list[int]:
        both.wait(HANG)  # for the other question
        return [request.a]

    with ros2.Node("/s") as server, ros2.Node("/c") as asker:
        server.service("/meet", ADD, meet, threads=2)
        client = asker.client("/meet", ADD)
        assert client.wait(HANG)
        asked = [client.ask([number, 0]) for number in range(2)]
        assert [each.result(HANG).sum for each in asked] == [0, 1]


def test_a_server_that_goes(names: yarpy.LocalNames, asked: list[Question]) -> None:
    worker = Worker("test")
    server = Answerer(Node("/", "s"), 0, "/goes", ADD, asked.append, worker)
    caller = Caller(Node("/", "c"), 0, "/goes", ADD)
    assert caller.wait(HANG)
    future = caller.ask([1, 2])
    wait_until(lambda: asked)
    server.close()
    worker.close()
    asked.clear()  # and with it the question
    with pytest.raises(yarpy.errors.LinkClosed, match="went away"):
        future.result(HANG)
    with pytest.raises(yarpy.errors.UnknownName, match="nobody serves /goes"):
        caller.ask([1, 2]).result(HANG)
    caller.close()
