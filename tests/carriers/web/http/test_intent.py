"""What a request asks for, as values: the right that it needs, and the message for the port."""

import pytest

from yarpy.carriers.web.http.intent import READS, Intent
from yarpy.wire.message import ADMIN, CALL, DATA, JSON


@pytest.mark.parametrize(
    ("key", "right"),
    [
        ("*", "ask"),
        ("?", "ask"),
        ("h", "ask"),
        (ADMIN, "ask"),
        ("r", "hear"),
        (CALL, "write"),
        (DATA, "write"),
        ("/", "administer"),
        ("!", "administer"),
        ("", "administer"),
    ],
)
def test_the_right_of_each_command(key: str, right: str) -> None:
    assert Intent(key, "json").right == right


def test_what_changes_nothing_does_not_act() -> None:
    assert not any(Intent(key, "page").acts for key in READS)
    assert all(Intent(key, "page").acts for key in (CALL, DATA, ADMIN, "/"))


def test_a_question_is_known_by_its_first_word() -> None:
    for text, asks in (
        (b" get encs", True),
        (b"list", True),
        (b"set pos 0 1", False),
        (b"", False),
    ):
        assert Intent(CALL, "json", text).asks is asks
    assert not Intent(DATA, "none", b"get encs").asks  # nobody hears the answer
    assert not Intent(CALL, "json", b"get encs", "binary").asks


def test_the_message_of_a_call_in_json_asks_for_values() -> None:
    message = Intent(CALL, "json", b"list").message("5 1.5")
    assert (message.key, message.text, message.envelope) == (CALL, JSON, "5 1.5")
    assert bytes(message.payload) == b"list"
    assert Intent(ADMIN, "json", b"ver").message().text == ""
    assert Intent(CALL, "page", b"list").message().text == ""
