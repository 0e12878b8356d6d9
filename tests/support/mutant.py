"""Carriers that are nearly right, to test what tests carriers."""

from __future__ import annotations

from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import FastTcp
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream


class Plain(Carrier):
    """A carrier that is right: what the mutants have in common."""

    name = "plain"
    magic = b"PLAIN___"


class NoEnvelope(Plain):
    """Forgets the envelope."""

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        super().encode(stream, Packet(packet.value, key=packet.key))


class OddReply(FastTcp):
    """Replies with something else."""

    name = "plain"
    code = 4

    @classmethod
    def matches(cls, value: int) -> bool:
        return value == cls.code

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        super().encode_reply(stream, ["wrong"])
