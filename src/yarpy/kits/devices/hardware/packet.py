"""Packets of servo buses: Dynamixel 2.0, and 1.0, which Feetech servos speak too.

    Version1().packet(1, READ, b"\\x38\\x02")      bytes to send: two registers from 56 of servo 1
    Version1().split(received)                    (Status of the first whole packet, what is behind)

Rules: pure functions of bytes. What comes before a packet, and packets whose sum is wrong, is
skipped: lines are noisy. Numbers in registers are little endian in both.

Source: the protocols 1.0 and 2.0 of ROBOTIS' e-manual; the protocol manual of Feetech's STS servos.
"""

from __future__ import annotations

from typing import Final, NamedTuple, Protocol

PING, READ, WRITE, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x82, 0x83
STATUS: Final = 0x55  # the instruction of answers in 2.0
#: The number that all servos listen to.
ALL: Final = 0xFE


class Status(NamedTuple):
    """An answer: of which servo, its error bits, and what was read."""

    servo: int
    error: int
    data: bytes


class Form(Protocol):
    """The form of packets on a line."""

    def packet(self, servo: int, instruction: int, parameters: bytes) -> bytes:
        """Return the packet that tells a servo to do something."""

    def span(self, register: int, size: int) -> bytes:
        """Return the parameters that name registers: the first, and how many."""

    def split(self, received: bytes) -> tuple[Status | None, bytes]:
        """Return the first answer and what is behind it; None and what may become one if there is
        none yet."""


class Version1:
    """1.0: FF FF id length instruction parameters, and the inverted sum of these."""

    def packet(self, servo: int, instruction: int, parameters: bytes) -> bytes:
        inner = bytes((servo, len(parameters) + 2, instruction)) + parameters
        return b"\xff\xff" + inner + bytes((~sum(inner) & 0xFF,))

    def span(self, register: int, size: int) -> bytes:
        return bytes((register, size))

    def split(self, received: bytes) -> tuple[Status | None, bytes]:
        while (at := received.find(b"\xff\xff")) >= 0:
            found = received[at:]
            if len(found) < 4:
                return None, found
            servo, length = found[2], found[3]
            end = 4 + length
            if servo >= ALL or length < 2:
                received = found[1:]
            elif len(found) < end:
                return None, found
            elif found[end - 1] == ~sum(found[2 : end - 1]) & 0xFF:
                return Status(servo, found[4], found[5 : end - 1]), found[end:]
            else:
                received = found[1:]
        return None, received[-1:] if received.endswith(b"\xff") else b""


class Version2:
    """2.0: FF FF FD 00 id length instruction parameters, and a CRC-16 of all."""

    def packet(self, servo: int, instruction: int, parameters: bytes) -> bytes:
        # FF FF FD within a packet gets another FD, so that it does not look like a new one.
        inner = (bytes((instruction,)) + parameters).replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
        head = b"\xff\xff\xfd\0" + bytes((servo,)) + (len(inner) + 2).to_bytes(2, "little")
        return head + inner + crc(head + inner).to_bytes(2, "little")

    def span(self, register: int, size: int) -> bytes:
        return register.to_bytes(2, "little") + size.to_bytes(2, "little")

    def split(self, received: bytes) -> tuple[Status | None, bytes]:
        while (at := received.find(b"\xff\xff\xfd\0")) >= 0:
            found = received[at:]
            if len(found) < 7:
                return None, found
            end = 7 + int.from_bytes(found[5:7], "little")
            if not 11 <= end <= 1024:
                received = found[1:]
                continue
            if len(found) < end:
                return None, found
            sums = crc(found[: end - 2]) == int.from_bytes(found[end - 2 : end], "little")
            inner = found[7 : end - 2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
            if sums and inner[0] == STATUS:
                return Status(found[4], inner[1], inner[2:]), found[end:]
            # What we said ourselves may come back on a line of one wire.
            received = found[end:] if sums else found[1:]
        return None, received[-3:]


def crc(data: bytes) -> int:
    """Return the CRC-16 of Dynamixel 2.0: the polynomial 8005, from 0, not reflected."""
    found = 0
    for each in data:
        found = ((found << 8) & 0xFFFF) ^ _TABLE[(found >> 8) ^ each]
    return found


def _entry(value: int) -> int:
    value <<= 8
    for _ in range(8):
        value = (value << 1) ^ 0x8005 if value & 0x8000 else value << 1
    return value & 0xFFFF


_TABLE: Final = tuple(map(_entry, range(256)))
