"""A bus of servos that are not there, at the other end of a pseudo terminal.

    with ServoBus(FEETECH, [1, 2]) as bus:          # bus.port is the line
        bus.servos[1][56] = 10                      # its registers, bytes

Rules: written from the manuals of the protocols, with packets put together here: what it is for
must not test itself. Servos that are not in `ids` are silent. While `late` is a list they answer
into it.
"""

from __future__ import annotations

import fcntl
import os
import termios
import threading
import tty
from array import array
from contextlib import suppress
from typing import Self

from support.wait import wait_until


class ServoBus:
    """Servos with 256 registers each. version: of the protocol, 1 or 2."""

    def __init__(self, version: int, ids: list[int]) -> None:
        self.version = version
        self.servos = {one: bytearray(256) for one in ids}
        self._master, slave = os.openpty()
        tty.setraw(slave)
        self.port = os.ttyname(slave)
        self._slave = slave
        self._heard = b""
        self.late: list[bytes] | None = None
        self._waits = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        os.write(self._slave, b"end")  # wakes the thread
        self._thread.join(10)
        os.close(self._slave)
        os.close(self._master)

    def number(self, servo: int, register: int, size: int) -> int:
        """Return a number in registers."""
        return int.from_bytes(self.servos[servo][register : register + size], "little")

    def put(self, servo: int, register: int, size: int, number: int) -> None:
        """Put a number into registers."""
        self.servos[servo][register : register + size] = number.to_bytes(size, "little")

    def catch_up(self) -> None:
        """Send what is late; return when it has come to the other end. What is asked then is
        answered when nothing of it is left there."""
        said, self.late, self._waits = b"".join(self.late or ()), None, True
        before = self._waiting()
        os.write(self._master, said)
        wait_until(lambda: self._waiting() == before + len(said))

    def _waiting(self) -> int:
        found = array("i", [0])
        fcntl.ioctl(self._slave, termios.FIONREAD, found)
        return found[0]

    def _say(self, data: bytes) -> None:
        if self._waits:
            wait_until(lambda: not self._waiting())
            self._waits = False
        if self.late is None:
            os.write(self._master, data)
        else:
            self.late.append(data)

    def _run(self) -> None:
        with suppress(OSError):
            while True:
                self._heard += os.read(self._master, 4096)
                if self._heard.endswith(b"end"):
                    return
                while (packet := self._next()) is not None:
                    self._obey(*packet)

    def _next(self) -> tuple[int, bytes] | None:
        """The instruction and the parameters of the next packet."""
        head = 4 if self.version == 1 else 7
        if len(self._heard) < head:
            return None
        found = self._heard
        length = found[3] if self.version == 1 else int.from_bytes(found[5:7], "little")
        if len(found) < head + length:
            return None
        self._heard = found[head + length :]
        sums = 1 if self.version == 1 else 2
        return found[head], found[head + 1 : head + length - sums]

    def _obey(self, instruction: int, said: bytes) -> None:
        if self.version == 1:
            register, size, rest = said[0], said[1], said[2:]
        else:
            register, size, rest = said[0] | said[1] << 8, said[2] | said[3] << 8, said[4:]
        if instruction == 0x82:
            for servo in rest:
                if servo in self.servos:
                    self._answer(servo, bytes(self.servos[servo][register : register + size]))
        elif instruction == 0x83:
            for at in range(0, len(rest), size + 1):
                data = rest[at + 1 : at + 1 + size]
                if rest[at] in self.servos:
                    self.servos[rest[at]][register : register + size] = data

    def _answer(self, servo: int, data: bytes) -> None:
        if self.version == 1:
            inner = bytes((servo, len(data) + 2, 0)) + data
            self._say(b"\xff\xff" + inner + bytes((255 - sum(inner) % 256,)))
            return
        packet = b"\xff\xff\xfd\0" + bytes((servo,)) + (len(data) + 4).to_bytes(2, "little")
        packet += b"\x55\0" + data
        rest = 0  # division by the polynomial, bit by bit
        for byte in packet + b"\0\0":
            for bit in range(7, -1, -1):
                rest = rest << 1 | (byte >> bit & 1)
                if rest & 0x10000:
                    rest ^= 0x18005
        self._say(packet + rest.to_bytes(2, "little"))
