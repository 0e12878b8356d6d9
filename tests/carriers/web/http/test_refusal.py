"""The last answer on a connection: whole, readable, and an error on our side."""

from __future__ import annotations

import pytest

from yarpy.carriers.web.http.refusal import DRAIN, LINGER, refuse
from yarpy.errors import RemoteProtocolError, Timeout
from yarpy.testing import End
from yarpy.wire.effects import Within
from yarpy.wire.stream import ByteStream


def test_peer_is_told_and_has_the_time_to_read_it() -> None:
    end = End()
    end.begin(refuse(end.stream, 403, "not you", [("Allow", "POST")]))
    head, _, body = end.take().partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 403 Forbidden\r\nAllow: POST\r\n")
    assert head.endswith(b"Content-Length: 8\r\nConnection: close")
    assert body == b"not you\n"
    end.feed(b"rest")  # of the request
    assert not end.done
    with pytest.raises(RemoteProtocolError, match="403: not you"):
        end.feed_eof()


def test_peer_that_neither_goes_on_nor_goes_away_is_not_waited_for() -> None:
    stream = ByteStream()
    steps = refuse(stream, 413, "too much")
    assert next(steps) == Within(LINGER)
    assert steps.send(None) is None
    with pytest.raises(RemoteProtocolError, match="413: too much"):
        steps.throw(Timeout("slow"))


def test_of_what_is_sent_on_for_ever_only_so_much_is_read() -> None:
    end = End()
    end.begin(refuse(end.stream, 413, "too much"))
    with pytest.raises(RemoteProtocolError, match="413: too much"):
        for _ in range(2 * DRAIN >> 14):
            end.feed(bytes(1 << 14))
