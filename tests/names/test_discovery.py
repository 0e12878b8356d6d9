"""Multicast discovery: the datagrams, and both sides over real sockets."""

import socket
import threading
import time
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import held
from support.capture import load_capture
from support.lasted import lasted
from support.multicast import needs_multicast
from support.name_line import new_service
from support.port import free_port

from yarpy.contact import Contact
from yarpy.errors import DecodeError
from yarpy.limit import DISCOVERY_DATAGRAM
from yarpy.names.discovery import Responder, decode_datagram, encode_datagram, respond, search

CAPTURE = load_capture("detect_multicast")
GROUP = "239.255.77.77"  # not the group of real name servers, so that none of them mixes in


def test_recorded_datagrams() -> None:
    question, answer, goodbye = (step.data for step in CAPTURE.steps[:3])
    assert encode_datagram("NAME_SERVER query /root") == question
    assert decode_datagram(question) == "NAME_SERVER query /root"
    service = new_service()
    service.answer_text("register /root tcp 127.0.0.1 21600")
    assert respond(question, service.answer_multicast) == answer
    with pytest.raises(DecodeError, match="packet number -1"):
        decode_datagram(goodbye)
    assert respond(goodbye, service.answer_multicast) is None
    assert respond(answer, service.answer_multicast) is None, "our own answer comes back to us"


@pytest.mark.parametrize(
    ("datagram", "complaint"),
    [
        (b"", "only 0 bytes"),
        (b"\0" * 8, "only 8 bytes"),
        (b"\1\0\0\0\0\0\0\0hello\n", "checksum"),
        (encode_datagram("x")[:-1], "checksum"),
        (b"\x76\xe8\x1c\x34\0\0\0\0hi", "checksum|end of line"),
    ],
)
def test_unsound_datagrams(datagram: bytes, complaint: str) -> None:
    with pytest.raises(DecodeError, match=complaint):
        decode_datagram(datagram)
    assert respond(datagram, lambda line: line) is None


def test_only_questions_to_name_servers_are_answered() -> None:
    assert respond(encode_datagram("hello"), lambda line: line) is None
    assert respond(encode_datagram("NAME_SERVER q"), lambda line: None) is None
    forged = respond(encode_datagram("NAME_SERVER q"), lambda line: "one\r\ntwo\n")
    assert forged is not None
    assert decode_datagram(forged) == "one  two "


@given(st.binary(max_size=100))
def test_any_datagram(datagram: bytes) -> None:
    service = new_service()
    for data in (datagram, encode_datagram("NAME_SERVER " + datagram.decode("latin1"))):
        try:
            decode_datagram(data)
        except DecodeError:
            pass
        respond(data, service.answer_multicast)


@given(st.text(st.characters(exclude_characters="\r\n"), max_size=100))
def test_codec_there_and_back(line: str) -> None:
    try:
        line.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return
    assert decode_datagram(encode_datagram(line)) == line


@pytest.fixture
def port() -> Iterator[int]:
    """A port on which this computer can talk to the group."""
    needs_multicast()
    yield free_port()


def registered(line: str) -> str:
    return f"registration name {line.split()[-1]} ip 10.0.0.9 port 10000 type tcp"


def found_by(namespace: str, port: int) -> Contact | None:
    """What is found in the end, however busy the computer is."""
    return search(namespace, port, tries=60, group=GROUP)


def test_search_finds(port: int) -> None:
    with Responder(registered, port, group=GROUP):
        found = found_by("/root", port)
    assert found == Contact("tcp", "/root", "10.0.0.9", 10000)


def test_search_finds_the_right_one_among_noise(port: int) -> None:
    stop = threading.Event()

    def chatter() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as noise:
            while not stop.wait(0.001):
                noise.sendto(b"", (GROUP, port))
                noise.sendto(b"noise" * 10, (GROUP, port))
                noise.sendto(encode_datagram(registered("/another")), (GROUP, port))

    thread = threading.Thread(target=chatter)
    thread.start()
    try:
        with Responder(registered, port, group=GROUP):
            assert found_by("/mine", port) == Contact("tcp", "/mine", "10.0.0.9", 10000)
    finally:
        stop.set()
        thread.join()


def test_search_gives_up(port: int) -> None:
    start = time.monotonic()
    assert search("/root", port, timeout=0.05, tries=2, group=GROUP) is None
    assert time.monotonic() - start > 0.09 and lasted(start) < 2


def test_a_server_that_does_not_know_the_name(port: int) -> None:
    service = new_service()
    with Responder(service.answer_multicast, port, group=GROUP):
        assert search("/root", port, timeout=0.1, tries=1, group=GROUP) is None
        service.answer_text("register /root tcp h 5")
        assert found_by("/root", port) == Contact("tcp", "/root", "h", 5)


def test_two_servers_share_a_computer(port: int) -> None:
    one, two = new_service(), new_service()
    one.answer_text("register /one tcp h 1")
    two.answer_text("register /two tcp h 2")
    with (
        Responder(one.answer_multicast, port, group=GROUP),
        Responder(two.answer_multicast, port, group=GROUP),
    ):
        for name, number in (("/one", 1), ("/two", 2)):
            found = found_by(name, port)
            assert found is not None and found.port == number


def test_close_ends_the_thread(port: int) -> None:
    before = held.threads()
    responder = Responder(registered, port, group=GROUP)
    responder.close()
    responder.start()
    assert len(held.threads() - before) == 1
    start = time.monotonic()
    responder.close()
    responder.close()
    assert held.threads() <= before
    assert lasted(start) < 10
    responder.start()
    assert found_by("/again", port) is not None
    responder.close()


def test_a_question_as_large_as_can_be_does_no_harm(port: int) -> None:
    with Responder(registered, port, group=GROUP):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            text = "NAME_SERVER query " + "x" * (DISCOVERY_DATAGRAM - 100)
            sender.sendto(encode_datagram(text), (GROUP, port))
        assert found_by("/root", port) is not None
