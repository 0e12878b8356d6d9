"""Asking a node what a type looks like that nobody here knows: its `get_type_description`.

Rules: one question to the node that named the type, in a thread that may wait. What it says is
checked against the hash in its token, and kept.
"""

from __future__ import annotations

import threading
import time
from typing import Any, Final

from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros2.kind import key_of
from yarpy.peers.ros2.message.description import SERVICE, type_of
from yarpy.peers.ros2.message.hash import full_name
from yarpy.peers.ros2.message.library import default_library
from yarpy.peers.ros2.token import Token, gid
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.participant import Participant

TIMEOUT: Final = 3.0  # seconds for an answer


def describe(participant: Participant, token: Token, name: str, kind: str) -> Any:
    """The type package/Type that a token names, as its node describes it; UnknownType if that
    cannot say, or says another one."""
    from zenoh import QueryTarget
    from zenoh.handlers import Callback

    key = token.key
    assert key is not None
    service = default_library().service(SERVICE)
    asked = service.Request(type_name=full_name(name, kind), type_hash=key.hash)
    where = key_of(key.domain, f"{token.node}/get_type_description", service, False)
    answers: list[bytes] = []
    over = threading.Event()

    def heard(reply: Any) -> None:
        if reply.ok is not None:
            answers.append(bytes(reply.ok.payload))
            over.set()

    participant.session.get(
        str(where),
        Callback(heard, over.set, indirect=False),
        target=QueryTarget.ALL_COMPLETE,
        payload=b"".join(asked.to_ros()),
        attachment=attachment(1, time.time_ns(), gid(str(token))),
        timeout=TIMEOUT,
    )
    over.wait(TIMEOUT)
    if not answers:
        raise UnknownType(f"the node {token.node} does not describe its types")
    try:
        answer: Any = service.Response.from_ros(answers[0])
        if not answer.successful:
            raise UnknownType(f"the node {token.node} says: {answer.failure_reason[:200]}")
        found = type_of(answer.type_description, name, kind, key.hash)
    except DecodeError as error:
        raise UnknownType(f"the node {token.node} says nothing of use: {error}") from error
    default_library().keep(found)
    return found
