"""Port: writes at once, reads every message, asks and answers."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._abstract_contactable import UnbufferedContactable
from yarp._connection import Asking, Ended
from yarp._contact import Contact
from yarp._log import say
from yarp._portable import PortReader, PortWriter


class Port(UnbufferedContactable):
    """A plain port."""

    _answerable: bool = False

    def __init__(self) -> None:
        super().__init__()
        self._timeout: float | None = None

    def _make(self, name: str, tcp_port: int) -> Any:
        return yarpy.Port(name, tcp_port=tcp_port, names=self._names(), on_connection=self._event)

    def close(self) -> None:
        """Close it; the name is given back. Its reader gets a connection that is not valid."""
        was_open, reader = self._port is not None, self._reader
        super().close()
        if was_open and reader is not None:
            self._try(reader.read, Ended())

    def interrupt(self) -> None:
        """Stop reading and writing, until `resume`. Its reader is told as by `close`."""
        super().interrupt()
        if self._port is not None and self._reader is not None:
            self._try(self._reader.read, Ended())

    def write(self, writer: Any, reader: Any = None, callback: Any = None) -> bool:
        """Send; with a reader as the second argument, ask and read the answer into it."""
        if not isinstance(writer, PortWriter):
            raise TypeError(f"a port writes a Bottle, an image and the like, not {writer!r}")
        if reader is not None and isinstance(reader, PortReader):
            return self._answered(writer._outgoing(), reader)
        port = self._port
        if port is not None:
            try:
                found = self._leaving(writer)
                if isinstance(found, Asking):
                    return self._answered(found, found.reader)
                port.write(found, self._envelope)
            except yarpy.PortClosed:
                return False
            except (ValueError, OverflowError) as error:  # too deep, too large
                say("ERROR", f"|yarp.os.Port| {self._name}: {error}")
                return False
            if reader is not None and hasattr(reader, "onCompletion"):
                reader.onCompletion()
        return True

    def _answered(self, message: Any, reader: Any) -> bool:
        """Ask, and let `reader` read the answer; whether there is one."""
        if self._port is None:
            return False
        try:
            answers = self._port.ask(message, self._timeout)
        except yarpy.PortClosed:
            return False
        if not answers:
            return False
        try:
            reader._take(answers[-1])
        except yarpy.DecodeError:
            return False
        return True

    def read(self, reader: Any, willReply: bool = False) -> bool:
        """Wait for a message and read it; with `willReply`, `reply` has to follow."""
        port = self._port
        if port is None or self._pump is not None:
            return False
        self._drop_question()
        try:
            self._last = message = port.read()
        except yarpy.PortClosed:
            return False
        self._answerable = willReply
        try:
            reader._take(message)
            return True
        except yarpy.DecodeError:
            return False
        finally:
            if not willReply:
                self._drop_question()

    def _drop_question(self) -> None:
        """Let a caller go on who gets no answer."""
        message = self._last
        if message is not None and message.wants_reply:
            try:
                message.reply(yarpy.Bottle())
            except yarpy.YarpError:
                pass

    def reply(self, writer: Any) -> bool:
        """Answer the message that was read last."""
        message = self._last
        if message is None or not self._answerable:
            return False
        self._answerable = False
        if message.wants_reply:
            try:
                message.reply(writer._outgoing())
            except yarpy.YarpError:
                return False
        return True

    def replyAndDrop(self, writer: Any) -> bool:
        """Answer, and end the connection."""
        message = self._last
        done = self.reply(writer)
        port = self._port
        if done and message is not None and port is not None:
            for link in port.inputs:
                if link.source == message.source:
                    link.close()
        return done

    def isOpen(self) -> bool:
        return self._port is not None

    def openFake(self, name: str) -> bool:
        """A name without a port."""
        self._name = name
        return True

    def sharedOpen(self, port: Any) -> bool:
        """Be the same port as another."""
        self._port, self._name = port._port, port._name
        return self._port is not None

    def enableBackgroundWrite(self, backgroundFlag: bool) -> None:
        """`write` does not wait for readers anyway."""

    def setTimeout(self, timeout: float) -> bool:
        """How long answers are waited for."""
        self._timeout = timeout if timeout > 0 else None
        return True

    def setAdminMode(self, adminMode: bool = True) -> None:
        """Let this port be asked about itself as if it were administrative: not needed."""

    def setReaderCreator(self, creator: Any) -> None:
        """Hand each connection to a reader of its own: one serves all here."""
        self.setReader(creator.create())

    def asPort(self) -> Port:
        return self

    @property
    def _here(self) -> Contact:
        return self.where()
