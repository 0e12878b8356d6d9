"""What a client is sent: at the cursor, while it plays, when it makes no sense."""

from __future__ import annotations

import json

import pytest
from support.foxglove_client import Client
from support.recordings import START, STEP

from yarpy.kits.record.view.server import View
from yarpy.kits.record.view.session import AT_ONCE


def test_the_cursor(view: View) -> None:
    with Client(view.url) as client:
        client.subscribe("/a", 7)
        _, number, time, payload = client.until("message")
        assert (number, time, json.loads(payload)["v"]) == (7, START, [0, 0.5])
        client.control(True, seek=START + 42 * STEP + 5, name="r1")
        assert client.until("state") == ("state", "paused", START + 42 * STEP + 5, 1.0, True, "r1")
        _, _, time, payload = client.until("message")
        assert time == START + 42 * STEP and json.loads(payload)["envelope"] == "42 42.5"
        # A picture is that of the cursor, however long ago it came.
        client.subscribe("/cam", 8)
        _, number, time, payload = client.until("message")
        assert (number, time) == (8, START + 40 * STEP) and b"\xff\xd8" in payload
        client.order("unsubscribe", subscriptionIds=[8])
        client.control(True, seek=START + 50 * STEP)
        assert client.until("message")[1:3] == (7, START + 50 * STEP)
        assert client.until("time") == ("time", START + 50 * STEP)


def test_playing_to_the_end(view: View) -> None:
    with Client(view.url) as client:
        client.subscribe("/a", 7)
        client.subscribe("/cam", 8)
        client.until("message")
        client.until("message")
        client.control(False, speed=4.0, seek=START, name="go")
        came: dict[int, set[int]] = {7: set(), 8: set()}
        state = ""
        while state != "ended":
            kind, *found = client.until("message", "state")
            if kind == "message":
                came[found[0]].add((found[1] - START) // STEP)
            else:
                state = found[0]
        # At most so many of a port are sent at once, the newest: a slow machine misses some.
        assert came[7] >= {*range(100 - AT_ONCE, 100)} and 90 in came[8]
        assert came[7] <= {*range(100)} and came[8] <= {*range(0, 100, 10)}
        # Playing begins anew at the beginning.
        client.control(False)
        assert client.until("state")[1] == "playing"
        assert client.until("message")[2] == START


def test_what_makes_no_sense_is_told(view: View) -> None:
    with Client(view.url) as client:
        client.order("sing")
        assert "sing" in client.until("status")["message"]
        client.order("subscribe", subscriptions=[{"id": 1, "channelId": 99}])
        assert client.until("status") == {
            "op": "status",
            "level": 2,
            "message": "there is no channel 99",
        }
        client.order("subscribe", subscriptions="all")
        assert client.until("status")["level"] == 2
        client.control(True, speed=float("nan"))
        assert "makes no sense" in client.until("status")["message"]
        client.order("x" * (1 << 19))
        with pytest.raises((EOFError, ConnectionError)):
            client.until("never")
