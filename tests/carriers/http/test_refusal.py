"""The last answer on a connection: whole, readable, and an error on our side."""

from __future__ import annotations

import pytest

from yarpy.carriers.http.refusal import refuse
from yarpy.errors import RemoteProtocolError
from yarpy.testing import End


def test_peer_is_told_and_has_the_time_to_read_it() -> None:
    end = End()
    end.begin(refuse(end.stream, 403, "not you", [("Allow", "POST")], rest=4))
    head, _, body = end.take().partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 403 Forbidden\r\nAllow: POST\r\n")
    assert head.endswith(b"Content-Length: 8\r\nConnection: close")
    assert body == b"not you\n"
    end.feed(b"rest")  # of the request
    assert not end.done
    with pytest.raises(RemoteProtocolError, match="403: not you"):
        end.feed_eof()
