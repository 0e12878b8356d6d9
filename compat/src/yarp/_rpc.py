"""RpcServer and RpcClient."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._abstract_contactable import AbstractContactable
from yarp._connection import Asking
from yarp._log import say
from yarp._port import Port


class RpcServer(Port, AbstractContactable):
    """Reads questions and answers them."""

    def read(self, reader: Any, willReply: bool = True) -> bool:
        """Wait for a question; `reply` has to follow."""
        if not willReply:
            say(
                "ERROR",
                f"|yarp.os.RpcServer| {self._name} must reply, please use a regular Port if you "
                "do not want to",
            )
            return False
        return super().read(reader, True)

    def write(self, writer: Any, reader: Any = None, callback: Any = None) -> bool:
        """A server does not write."""
        say("ERROR", f"|yarp.os.RpcServer| {self._name} can only answer")
        return False


class RpcClient(AbstractContactable):
    """Asks the port that it is connected to."""

    def __init__(self) -> None:
        super().__init__()
        self._timeout: float | None = None

    def _make(self, name: str, tcp_port: int) -> Any:
        return yarpy.RpcClient(
            name=name, tcp_port=tcp_port, names=self._names(), on_connection=self._event
        )

    def write(self, writer: Any, reader: Any = None, callback: Any = None) -> bool:
        """Ask, and read the answer into the second argument; False if there is none."""
        if self._port is None:
            return False
        try:
            question = writer._outgoing()
            answer = self._port.ask(question, self._timeout)
            if answer is None:
                return False
            if isinstance(question, Asking) and reader is None:
                reader = question.reader
            if reader is not None:
                reader._take(answer)
        except yarpy.YarpError:
            return False
        return True

    def read(self, reader: Any, willReply: bool = False) -> bool:
        """A client is not asked."""
        return False

    def reply(self, writer: Any) -> bool:
        return False

    def replyAndDrop(self, writer: Any) -> bool:
        return False

    def setTimeout(self, timeout: float) -> bool:
        """How long answers are waited for."""
        self._timeout = timeout if timeout > 0 else None
        return True

    def asPort(self) -> RpcClient:
        return self
