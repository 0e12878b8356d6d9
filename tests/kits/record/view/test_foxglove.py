"""The protocol, against frames of Foxglove's own server."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.record.view import foxglove
from yarpy.kits.record.view.foxglove import Channel, Control


def test_frames() -> None:
    payload = bytes.fromhex("0a0808011080cab5ee01120f0a046e65636b11000000000000e03f")
    head = bytes.fromhex("0109000000002f685900000000")
    assert foxglove.message_data(9, 1_500_000_000, payload) == head + payload
    assert foxglove.time_data(1_500_000_000).hex() == "02002f685900000000"
    found = foxglove.playback_state("paused", 1_795_000_005_000_000_000, 2.0, True, "r1")
    assert found.hex() == "05010072d985fe1ee9180000004001020000007231"


def test_wishes() -> None:
    data = bytes.fromhex("0301000000400100 72d985fe1ee918 02000000") + b"r1"
    assert foxglove.control_of(data) == Control(True, 2.0, 1_795_000_005_000_000_000, "r1")
    assert foxglove.control_of(bytes.fromhex("03000000803f00" + 8 * "00" + "00000000")) == Control(
        False, 1.0, None, ""
    )
    assert foxglove.control_of(b"\x01....") is None and foxglove.control_of(b"") is None
    for cut in range(1, len(data)):
        with pytest.raises(DecodeError):
            foxglove.control_of(data[:cut])
    for speed in ("0000c07f", "00000000", "0000807f"):  # not a number, zero, infinite
        with pytest.raises(DecodeError):
            foxglove.control_of(bytes.fromhex(f"0301{speed}00" + 12 * "00"))


def test_texts() -> None:
    info = foxglove.server_info("x", "1", 1_795_000_000_000_000_001, 1_795_000_060_000_000_000)
    assert info["dataStartTime"] == {"sec": 1795000000, "nsec": 1}
    assert info["capabilities"] == ["time", "playbackControl"]
    assert "dataEndTime" not in foxglove.server_info("x", "1")
    (told,) = foxglove.advertise([Channel(1, "/cam", "json", "a", "{}", "jsonschema")])["channels"]
    wanted = {"id", "topic", "encoding", "schemaName", "schema", "schemaEncoding"}
    assert set(told) == wanted and foxglove.status("x", 2)["level"] == 2


def test_orders() -> None:
    word, order = foxglove.order_of(
        '{"op": "subscribe", "subscriptions": [{"id": 7, "channelId": 1}]}'
    )
    assert word == "subscribe" and foxglove.subscriptions_of(order) == [(7, 1)]
    assert foxglove.numbers_of({"subscriptionIds": [1, 2]}, "subscriptionIds") == [1, 2]
    for text in ("", "[]", "{}", '{"op": 1}', "[" * 100_000):
        with pytest.raises(DecodeError):
            foxglove.order_of(text)
    bad = ({}, {"subscriptions": 1}, {"subscriptions": [1]}, {"subscriptions": [{"id": -1}]})
    for order in (*bad, {"subscriptions": [{"id": True, "channelId": 1}]}):
        with pytest.raises(DecodeError):
            foxglove.subscriptions_of(order)
    with pytest.raises(DecodeError):
        foxglove.numbers_of({"subscriptionIds": [1 << 32]}, "subscriptionIds")
