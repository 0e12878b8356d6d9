"""Registration lines, there and back, and what is no registration."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.contact import Contact
from yarpy.names.registration_line import parse_registration, plain, registration_line

LINES = [
    (Contact("tcp", "/x", "127.0.0.1", 21102), "name /x ip 127.0.0.1 port 21102 type tcp"),
    (Contact("tcp", "", "127.0.0.1", 21613), "name  ip 127.0.0.1 port 21613 type tcp"),
    (Contact("udp", "/t/with space", "h", 1), "name /t/with space ip h port 1 type udp"),
    (Contact("tcp", "/a ip b", "::1", 1), "name /a ip b ip ::1 port 1 type tcp"),
    (Contact("", "/root", "h", 10000), "name /root ip h port 10000 type "),
    (Contact("tcp+send.portmonitor+file.x", "/a", "h", 1), None),
]


@pytest.mark.parametrize(("contact", "text"), LINES)
def test_there_and_back(contact: Contact, text: str | None) -> None:
    line = registration_line(contact)
    assert text is None or line == f"registration {text}"
    assert parse_registration(line) == contact
    assert parse_registration(line + "\r\n") == contact


@pytest.mark.parametrize(
    "line",
    [
        "",
        "*** end of message",
        "registration",
        "registration name /x ip h port x type tcp",
        "registration name /x ip h port 70000 type tcp",
        "registration name /x ip h port -1 type tcp",
        "registration name /x ip h port 99999999999999999999 type tcp",
        "error ran out of port numbers",
        "[ok]",
    ],
)
def test_no_registration(line: str) -> None:
    assert parse_registration(line) is None


def test_a_name_cannot_forge_a_line() -> None:
    contact = Contact("tcp", '/a"\r\n*** end of message\\', "h", 1)
    line = registration_line(contact)
    assert "\n" not in line and "\r" not in line and '"' not in line


@given(st.text(max_size=300))
def test_any_line_parses_or_not(line: str) -> None:
    contact = parse_registration(line)
    assert contact is None or 0 <= contact.port <= 65535
    assert "\n" not in plain(line)


def test_a_name_that_a_terminal_would_obey_is_no_registration() -> None:
    assert parse_registration("registration name /a\x1b[2J ip h port 1 type tcp") is None
