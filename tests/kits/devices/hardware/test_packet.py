"""Packets of servo buses, byte for byte as the manuals have them."""

from __future__ import annotations

import pytest

from yarpy.kits.devices.hardware.packet import (
    ALL,
    PING,
    READ,
    SYNC_WRITE,
    WRITE,
    Form,
    Status,
    Version1,
    Version2,
)

ONE, TWO = Version1(), Version2()


def test_packets_of_version_1() -> None:
    assert ONE.packet(1, PING, b"") == bytes.fromhex("ffff010201fb")
    # Two registers from 56 of servo 1, as Feetech's manual asks for its position.
    assert ONE.packet(1, READ, ONE.span(56, 2)) == bytes.fromhex("ffff0104023802be")
    told = ONE.packet(ALL, SYNC_WRITE, ONE.span(0x2A, 2) + b"\x01\x00\x08\x02\x00\x08")
    assert told == bytes.fromhex("fffffe0a832a0201000802000835")


def test_packets_of_version_2() -> None:
    # Those of the manual: a ping, the position of servo 1, and 512 as its goal.
    assert TWO.packet(1, PING, b"") == bytes.fromhex("fffffd0001030001194e")
    asked = TWO.packet(1, READ, TWO.span(132, 4))
    assert asked == bytes.fromhex("fffffd0001070002840004001d15")
    told = TWO.packet(1, WRITE, b"\x74\x00" + (512).to_bytes(4, "little"))
    assert told == bytes.fromhex("fffffd0001090003740000020000ca89")


def test_answers_of_version_2() -> None:
    # The manual's answer to the question above: 166.
    answer = bytes.fromhex("fffffd000108005500a60000008cc0")
    assert TWO.split(b"noise" + answer + b"\xff") == (
        Status(1, 0, b"\xa6\x00\x00\x00"),
        b"\xff",
    )


def test_a_head_within_a_packet_of_version_2() -> None:
    packet = TWO.packet(3, 0x55, b"\0\xff\xff\xfd\x01")
    assert b"\xff\xff\xfd\xfd\x01" in packet
    assert TWO.split(packet) == (Status(3, 0, b"\xff\xff\xfd\x01"), b"")


@pytest.mark.parametrize("form", [ONE, TWO], ids=["1", "2"])
def test_answers_come_in_pieces_and_with_noise(form: Form) -> None:
    first = form.packet(1, 0x00 if form is ONE else 0x55, b"\x10\x20" if form is ONE else b"\0\x10")
    second = form.packet(2, 0x20 if form is ONE else 0x55, b"\x30" if form is ONE else b"\x20\x30")
    broken = first[:-1] + bytes((first[-1] ^ 1,))
    whole = b"\xff\x01" + broken + first + second
    found, received = [], b""
    for each in whole:
        received += bytes((each,))
        status, received = form.split(received)
        if status is not None:
            found.append(status)
    assert [(each.servo, each.error) for each in found] == [(1, 0), (2, 0x20)]
    assert found[1].data == b"\x30"
    assert len(received) < 4


def test_what_we_said_ourselves_is_no_answer() -> None:
    asked = TWO.packet(1, READ, TWO.span(132, 4))
    assert TWO.split(asked)[0] is None
    assert ONE.split(ONE.packet(ALL, SYNC_WRITE, b"\x2a\x02"))[0] is None
