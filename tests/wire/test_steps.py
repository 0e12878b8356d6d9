"""Steps: bytes and effects are asked for in one order, and answered in it."""

from dataclasses import dataclass

import pytest

from yarpy.wire.steps import Effect, Steps


@dataclass(frozen=True, slots=True)
class Ask(Effect):
    what: str


def protocol() -> Steps[str]:
    yield None
    answer: str = yield Ask("time")
    return answer


def test_steps_ask_and_are_answered() -> None:
    steps = protocol()
    assert next(steps) is None
    assert steps.send(None) == Ask("time")
    with pytest.raises(StopIteration) as stop:
        steps.send("noon")
    assert stop.value.value == "noon"
    assert not hasattr(Ask("x"), "__dict__")
