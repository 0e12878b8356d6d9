"""The suite for middlewares, on those that are ports; guests have it in their own folders."""

from __future__ import annotations

from typing import Any

import pytest
from support.guest import guest

guest("wrap", ring="kits")
from yarpy.kits.wrap.websocket import WebSocket  # noqa: E402
from yarpy.kits.wrap.yarp import Yarp  # noqa: E402
from yarpy.testing import MiddlewareConformance, private_names  # noqa: E402


@pytest.fixture(autouse=True)
def alone() -> Any:
    with private_names():
        yield


class TestYarp(MiddlewareConformance):
    middleware = Yarp


class TestWebSocket(MiddlewareConformance):
    middleware = WebSocket


class Deaf(Yarp):
    """Answers every question with the same."""

    def server(self, binding: Any, name: str, answer: Any) -> Any:
        return super().server(binding, name, lambda args, kwargs: answer(["always"], {}))


def test_a_middleware_that_is_wrong_is_caught() -> None:
    class Suite(MiddlewareConformance):
        middleware = Deaf

    with pytest.raises(AssertionError):
        Suite().test_questions_are_answered()
