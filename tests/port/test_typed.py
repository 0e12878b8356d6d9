"""Ports for one type of message: what they read is of that type, or an error says what came."""

import pickle
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
import pytest
from support.wait import HANG

import yarpy
from yarpy import aio
from yarpy.port.typed import of_type

S = TypeVar("S")


@dataclass
class Observation:
    rgb: np.ndarray
    joints: list[float]


SEEN = Observation(np.arange(12, dtype="u1").reshape(2, 2, 3), [0.5, 1.0])


@pytest.fixture
def writer(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/writer", names=names) as port:
        yield port


@pytest.mark.parametrize("kind", [yarpy.Port, yarpy.BufferedPort])
@pytest.mark.parametrize("carrier", ["tcp", "memory", "text_ack", "local"])
def test_what_is_read_is_of_the_type(kind: Any, carrier: str, names: Any, writer: yarpy.Port):
    with kind[Observation]("/reader", names=names) as reader:
        writer.connect("/reader", carrier)
        threading.Thread(target=writer.write, args=(SEEN,)).start()
        message = reader.read(timeout=HANG)
        assert type(message.value) is Observation
        assert message.value.joints == SEEN.joints
        assert np.array_equal(message.value.rgb, SEEN.rgb)
        assert dict(message.as_(dict)).keys() >= {"rgb", "joints"}
        assert '"joints": [0.5, 1.0]' in message.to_json()


def test_another_thing_is_an_error_where_the_value_is_asked_for(names: Any, writer: yarpy.Port):
    with yarpy.BufferedPort[yarpy.Image]("/reader", strict=True, names=names) as reader:
        writer.connect("/reader")
        writer.write(["no picture"])
        message = reader.read(timeout=HANG)
        with pytest.raises(yarpy.DecodeError, match="Image"):
            _ = message.value
        assert message.as_(yarpy.Bottle) == ["no picture"]
        writer.write(yarpy.Image(np.zeros((2, 3), "u1")))
        assert reader.read(timeout=HANG).value.array.shape == (2, 3)


def test_polling_and_iterating_give_the_type(names: Any, writer: yarpy.Port):
    with yarpy.BufferedPort[list[float]]("/reader", strict=True, names=names) as reader:
        writer.connect("/reader")
        writer.write([1, 2], wait=True)
        message = reader.poll()
        assert message is not None and message.value == [1.0, 2.0]
        assert type(message.value[0]) is float and type(message.value) is list
        writer.write([3])
        assert next(iter(reader)).value == [3.0]


def test_a_callback_gets_the_type_and_what_is_wrong_is_logged(
    names: Any, writer: yarpy.Port, caplog: pytest.LogCaptureFixture
):
    came: list[object] = []
    told = threading.Event()

    def take(message: yarpy.Message[Observation]) -> None:
        came.append(message.value)
        told.set()

    with yarpy.Port[Observation]("/reader", callback=take, names=names):
        writer.connect("/reader")
        writer.write([1], wait=True)
        writer.write(SEEN)
        assert told.wait(HANG)
    assert [type(one) for one in came] == [Observation]
    assert "expected an Observation" in caplog.text


async def typed_loop(names: Any, writer: yarpy.Port) -> object:
    async with aio.BufferedPort[Observation]("/loop", names=names) as reader:
        writer.connect("/loop")
        writer.write(SEEN)
        return (await reader.read(timeout=HANG)).value


def test_in_an_event_loop(names: Any, writer: yarpy.Port):
    import asyncio

    found = asyncio.run(typed_loop(names, writer))
    assert type(found) is Observation


def test_the_class_is_made_once_and_says_what_it_is_for(names: Any):
    kind = yarpy.Port[yarpy.Image]
    assert kind is yarpy.Port[yarpy.Image] and issubclass(kind, yarpy.Port)
    assert kind is not yarpy.BufferedPort[yarpy.Image]
    with kind("/x", names=names) as port:
        assert repr(port).startswith("<Port[Image] /x ")
    with pytest.raises(TypeError, match="its type already"):
        kind[yarpy.Vector]


def test_a_class_of_the_program_keeps_the_parameter_open(names: Any):
    class Mine(yarpy.BufferedPort[S], Generic[S]):
        pass

    assert of_type(yarpy.Port, Any) is yarpy.Port
    with Mine[yarpy.Vector]("/mine", names=names) as port:
        assert isinstance(port, Mine)
        port.connect("/mine")
        port.write(yarpy.Vector([1.0]))
        assert type(port.read(timeout=HANG).value) is yarpy.Vector


def test_a_copy_of_a_message_keeps_the_type(names: Any, writer: yarpy.Port):
    with yarpy.BufferedPort[Observation]("/reader", names=names) as reader:
        writer.connect("/reader", "tcp")
        writer.write(SEEN)
        copy = pickle.loads(pickle.dumps(reader.read(timeout=HANG)))
    assert copy.value.joints == SEEN.joints
