"""Dialogues with C++ yarpserver 3.9.1, said again to our name service, byte for byte."""

import struct

import pytest
from support.capture import Capture, load_capture
from support.name_line import NameLines, TextLines, new_service

from yarpy.data.bottle import Bottle
from yarpy.nameserver.command import NameService

SERVER = 21600

# What the recorded server knew before a dialogue began, as commands. Every server begins with
# itself and the multicast entry.
BEGIN = [f"register /root tcp 127.0.0.1 {SERVER}", "register fallback mcast 224.2.1.1 10000"]
A = ["register /t/a"]
CPP = ["register /t/cpp"]
CPP2 = ["register /t/cpp2 tcp 127.0.0.1 21696"]
CAP = ["register /cap/in", "register /cap/srv", "register /cap/out"]


def commands_of(name: str) -> list[str]:
    """The commands of another dialogue: what it left behind is the beginning of this one."""
    steps = load_capture(name).steps
    return [s.data[12:].decode().strip("\r\n") for s in steps if s.sender == "a"]


ALL = commands_of("ns_register")

BEFORE: dict[str, list[str]] = {
    "ns_register": [],
    "ns_query": ALL,
    "ns_list": ALL,
    "ns_gc": [*ALL, "register /t/bot"],
    "ns_set_get": A,
    "ns_set_get_unknown_port": A,
    "ns_announce": A,
    "ns_route": [],
    "ns_topics": A,
    "ns_unregister": A,
    "ns_text_one_connection": [],
    "ns_text_split_header": A,
    "ns_open_auto_name": ["register ..."] * 2,
    "ns_open_close_bufin": [],
    "ns_open_close_out": [],
    "ns_open_close_rpcc": [],
    "ns_api_getProperty_1": [*CPP, 'set /t/cpp color "red 3"'],
    "ns_api_setProperty_1": CPP,
    "ns_api_registerName_1": [],
    "ns_api_registerName_2": CPP,
    "ns_api_registerName_3": CPP,
    "ns_api_registerName_4": CPP,
    "ns_api_registerName_auto_2": ["register ..."],
    "ns_api_registerName_auto_4": ["register ..."],
    "ns_api_registerName_auto_5": ["register ..."],
    "ns_api_registerContact_1": [],
    "ns_api_registerContact_2": CPP2,
    "ns_api_registerContact_3": CPP2,
    "ns_api_registerContact_4": CPP2,
    "ns_api_registerContact_5": CPP2,
    "ns_api_registerContact_mcast_1": ["register ..."],
    "ns_api_registerContact_mcast_2": ["register ..."] * 2,
    "ns_api_registerContact_mcast_3": ["register ..."] * 2,
    "ns_api_registerContact_mcast_4": ["register ..."] * 2,
    "ns_api_unregisterName_unknown_1": [],
    "mcast_ns_1": [],
    "mcast_ns_2": ["register ... mcast"],
    "mcast_ns_3": ["register ... mcast"],
    "mcast_ns_4": CAP,
    "cli_check_05_ns": ["register ..."],
    "cli_check_06_ns": ["register ..."],
    "cli_check_07_ns": ["register ..."],
    "cli_check_08_ns": ["register ..."],
    "cli_check_09_ns": ["register ..."],
    "cli_check_10_ns": ["register ..."] * 2,
    "cli_check_12_ns": ["register ..."] * 2,
    "cli_check_14_ns": ["register ..."] * 2,
    "cli_check_27_ns": ["register ..."],
    "cli_name_list_01_ns": CAP,
    "cli_name_query_01_ns": CAP,
    **{f"cli_read_0{n}_ns": ["register /cap/r"] for n in (3, 4, 5, 6, 7)},
    **{f"cli_rpc_json_0{n}_ns": ["register /cap/client"] for n in (1, 2, 3, 4, 5, 6, 8)},
    **{f"cli_write_0{n}_ns": ["register /cap/w"] for n in (2, 3, 4, 5, 6, 7)},
    "cli_write_16_ns": ["register /cap/w"],
}

TEXT: dict[str, list[str]] = {
    "ns_rpc_text_ack": A,
    "telnet_ns": ["register /cap/srv", "register /cap/in", "register /cap/out"],
    "cli_clean_01_ns": CAP,
    "cli_clean_05_ns": CAP,
    "cli_connect_persist_01_ns": CAP,
    "cli_disconnect_persist_01_ns": CAP,
    "cli_topic_01_ns": CAP,
    "cli_topic_connect_01_ns": CAP,
    "cli_topic_connect2_01_ns": CAP,
    "cli_topic_remove_01_ns": CAP,
}

# Dialogues whose numbers follow from what is recorded; in the others earlier traffic decided.
EXACT = {
    *("ns_register", "ns_query", "ns_list", "ns_gc", "ns_set_get", "ns_announce", "ns_topics"),
    *("ns_unregister", "ns_route", "ns_text_one_connection", "ns_text_split_header"),
    *("ns_rpc_text_ack", "telnet_ns", "cli_clean_01_ns", "cli_name_list_01_ns"),
    *("cli_name_query_01_ns",),
}


def service_after(commands: list[str]) -> NameService:
    service = new_service(SERVER)
    for command in [*BEGIN, *commands]:
        service.answer_text(command, "127.0.0.1")
    return service


def compare(capture: Capture, index: int, got: bytes) -> None:
    step = capture.steps[index]
    assert step.sender == "b"
    if capture.name in EXACT:
        assert got == step.data
    else:
        assert capture.masked(step, got) == capture.masked(step, step.data)


@pytest.mark.parametrize("pieces", [0, 1], ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", sorted(BEFORE))
def test_name_ser(name: str, pieces: int) -> None:
    capture = load_capture(name)
    service = service_after(BEFORE[name])
    lines: dict[int, NameLines] = {}
    for step in capture.steps:
        if step.sender == "a":
            connection = lines.setdefault(step.connection, NameLines(service))
            if pieces:
                got = b"".join(connection.feed(step.data[i : i + 1]) for i in range(len(step.data)))
            else:
                got = connection.feed(step.data)
            compare(capture, step.index + 1, got)


@pytest.mark.parametrize("name", sorted(TEXT))
def test_text(name: str) -> None:
    capture = load_capture(name)
    service = service_after(TEXT[name])
    connection = TextLines(service)
    for step in capture.steps:
        if step.sender == "a" and step.index + 1 < len(capture.steps):
            compare(capture, step.index + 1, connection.feed(step.data))


ACK = b"YA\0\0\0\0RP"


@pytest.mark.parametrize("name", ["ns_rpc_tcp", "ns_rpc_fast_tcp"])
def test_binary(name: str) -> None:
    """Bottles in; out comes a Bottle or, for old style, the text lines without any frame."""
    capture = load_capture(name)
    service = service_after(A)
    acks = ACK if name == "ns_rpc_tcp" else b""
    for step in capture.steps[2:]:
        if step.sender == "a":
            assert step.data[:8] == b"YA\x0a\0\0\0RP"
            _command, size = struct.unpack_from("<ii", step.data, 18)
            reply = service.answer(Bottle.from_bytes(step.data[-size:]), "127.0.0.1")
            got = reply.to_bytes() if reply.bottle is None else reply.bottle.to_bytes()
            assert got + acks == capture.steps[step.index + 1].data


def test_events() -> None:
    capture = load_capture("ns_events")
    service = service_after([])
    commands = ["register /t/x1", "unregister /t/x1", "register /t/evout", "unregister /t/evout"]
    messages = [step.data for step in capture.steps[2:] if step.sender == "a"]
    for command, message in zip(commands, messages, strict=True):
        (event,) = service.answer_text(command).events
        body = event.to_bytes()
        assert struct.unpack_from("<i", message, 22) == (len(body),)
        assert message.endswith(body)
